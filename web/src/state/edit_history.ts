import type { Edit, SceneMessage } from '../protocol/messages.gen';
import { editKey } from './edit_desk';
import { inverseOf } from './inverse';
import { withEdit } from './model';

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
  /** The technique whose parameters these are; null where the step is about something else. */
  technique: string | null;
}

const kDepth = 200;

const sameValues = (a: object, b: object): boolean => JSON.stringify(a) === JSON.stringify(b);

/** The technique that an edit of parameters alone is about; null for any other edit. */
const techniqueOf = (scene: SceneMessage, edit: Edit): string | null =>
  edit.target === 'technique' && edit.technique === undefined ? scene.technique : null;

/** The edits made by hand in this page, to be undone and redone. All edits of one thing in one gesture are a step. */
export class EditHistory {
  private done: Step[] = [];
  private undone: Step[] = [];
  private inGesture = false;
  private things = '';

  constructor(private readonly hooks: HistoryHooks) {}

  /** Applies an edit and remembers what was there before, where that can be put back. */
  edit(label: string, edit: Edit): void {
    const scene = this.hooks.scene();
    const before = scene && inverseOf(scene, edit);
    if (!before) this.cutOff();
    else if (!sameValues(before, edit))
      this.remember({ key: editKey(label, edit), label, before, after: edit, technique: techniqueOf(scene, edit) });
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

  /** Told of each scene. Steps hold absolute values: they outlast a connection as long as all things are there. */
  onScene({ cause, name, materials, lights, nodes }: SceneMessage): void {
    const things = [name, materials.length, lights.length, nodes.length].join();
    if (cause === 'loaded' || things !== this.things) this.clear();
    this.things = things;
  }

  private clear(): void {
    this.done = [];
    this.undone = [];
    this.hooks.onChange();
  }

  /** An edit that cannot be taken back: what was undone no longer follows from what is there. */
  private cutOff(): void {
    this.endGesture();
    this.undone = [];
    this.hooks.onChange();
  }

  private remember(step: Step): void {
    const last = this.done.at(-1);
    const goesOn = this.inGesture && last?.key === step.key && last.technique === step.technique;
    if (goesOn) last.after = step.after;
    else this.done = [...this.done, step].slice(-kDepth);
    this.inGesture = true;
    this.undone = [];
    this.hooks.onChange();
  }

  /** Drops steps that are of no use any more: the server refused them, or somebody else was there first. */
  private travel(from: Step[], to: Step[], side: 'before' | 'after'): string | null {
    this.endGesture();
    let step = from.pop();
    while (step && this.isPointless(step, side)) step = from.pop();
    if (step) {
      to.push(step);
      this.hooks.apply(step.label, step[side]);
    }
    this.hooks.onChange();
    return step?.label ?? null;
  }

  /** True when a step would change nothing that is known, or is about the parameters of another technique. */
  private isPointless(step: Step, side: 'before' | 'after'): boolean {
    const scene = this.hooks.scene();
    if (!scene || (step.technique !== null && step.technique !== scene.technique)) return true;
    return sameValues(withEdit(scene, step[side]), scene);
  }
}
