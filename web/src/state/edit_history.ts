import type { Edit, SceneMessage } from '../protocol/messages.gen';
import { editKey } from './edit_desk';
import { inverseOf } from './inverse';

export interface HistoryHooks {
  scene(): SceneMessage | null;
  /** Shows an edit and sends it. */
  apply(label: string, edit: Edit): void;
  /** There is more or less to undo or redo. */
  onChange(): void;
}

interface Step {
  key: string;
  label: string;
  before: Edit;
  after: Edit;
}

const kDepth = 200;

const sameEdit = (a: Edit, b: Edit): boolean => JSON.stringify(a) === JSON.stringify(b);

/** The edits made by hand in this page, to be undone and redone. All edits of one thing in one gesture are a step. */
export class EditHistory {
  private done: Step[] = [];
  private undone: Step[] = [];
  private inGesture = false;

  constructor(private readonly hooks: HistoryHooks) {}

  /** Applies an edit and remembers what was there before. */
  edit(label: string, edit: Edit): void {
    const before = this.inverse(edit);
    if (before && !sameEdit(before, edit)) this.remember({ key: editKey(label, edit), label, before, after: edit });
    this.hooks.apply(label, edit);
  }

  /** What comes next is a step of its own, also where it is about the same thing. */
  endGesture(): void {
    this.inGesture = false;
  }

  /** Undoes the newest step and returns its label; null where there is none. */
  undo(): string | null {
    return this.travel(this.done, this.undone, 'before');
  }

  /** Redoes the step that was undone last and returns its label; null where there is none. */
  redo(): string | null {
    return this.travel(this.undone, this.done, 'after');
  }

  /** Label of the step that `undo` would take. */
  nextUndo(): string | null {
    return this.done.at(-1)?.label ?? null;
  }

  /** Label of the step that `redo` would take. */
  nextRedo(): string | null {
    return this.undone.at(-1)?.label ?? null;
  }

  /** Another scene: its things have other values. */
  clear(): void {
    this.done = [];
    this.undone = [];
    this.hooks.onChange();
  }

  private inverse(edit: Edit): Edit | null {
    const scene = this.hooks.scene();
    return scene && inverseOf(scene, edit);
  }

  private remember(step: Step): void {
    const last = this.done.at(-1);
    if (this.inGesture && last?.key === step.key) last.after = step.after;
    else this.done = [...this.done, step].slice(-kDepth);
    this.inGesture = true;
    this.undone = [];
    this.hooks.onChange();
  }

  /** Drops steps that change nothing any more: the server refused them, or somebody else was there first. */
  private travel(from: Step[], to: Step[], side: 'before' | 'after'): string | null {
    this.endGesture();
    let step = from.pop();
    while (step && this.holds(step[side])) step = from.pop();
    if (step) {
      to.push(step);
      this.hooks.apply(step.label, step[side]);
    }
    this.hooks.onChange();
    return step?.label ?? null;
  }

  /** True when the scene is as `edit` would make it, or cannot be made so. */
  private holds(edit: Edit): boolean {
    const now = this.inverse(edit);
    return now === null || sameEdit(now, edit);
  }
}
