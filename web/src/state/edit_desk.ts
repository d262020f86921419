import type { FrameReport, Outgoing } from '../channel';
import type { Ack, CostClass, Edit, ErrorMessage, FrameHeader, SceneMessage, View } from '../protocol/messages.gen';
import { withEdit } from './model';

/** What became of one edit of this person. */
export interface Outcome {
  label: string;
  kind: 'applied' | 'failed' | 'unsent';
  camera: boolean;
  cost?: CostClass;
  /** From the input to the first presented frame that shows it; absent until then, and where nothing changed. */
  latencyMs?: number;
  message?: string;
}

export interface DeskHooks {
  /** Shows an edit at once, before the server hears of it. */
  show(edit: Edit): void;
  /** Hands a message to the worker under a ticket; `sent` comes back with its seq. */
  post(ticket: number, message: Outgoing): void;
  requestFrame(callback: (nowMs: number) => void): void;
  now(): number;
  onOutcome(outcome: Outcome): void;
}

interface Draft {
  label: string;
  edit: Edit;
  message: Outgoing;
  inputMs: number;
  camera: boolean;
}
interface Pending {
  draft: Draft;
  seq: number | null;
  cost: CostClass | null;
  /** That holds the edit; 0 until its acknowledgement tells. */
  sceneRevision: number;
}

/** True when the server reads a file before it applies the edit; edits that were sent after it may come first. */
const namesImage = (edit: Edit): boolean => edit.target === 'environment' && !!edit.image;

/** True when a picture holds the edit. */
function isShown({ draft, seq, cost, sceneRevision }: Pending, picture: FrameHeader): boolean {
  if (seq === null || seq > picture.ackSeq) return false;
  return !namesImage(draft.edit) || (cost !== null && sceneRevision <= picture.sceneRevision);
}

/** The same for edits of the same fields of the same thing; `label` tells the technique's parameters apart. */
export function editKey(label: string, edit: Edit): string {
  const index = 'material' in edit ? edit.material : 'light' in edit ? edit.light : 'node' in edit ? edit.node : 0;
  return `${edit.target}/${index}/${Object.keys(edit).sort().join()}/${label}`;
}

const kMinFlushMs = 1000 / 60 - 1;

/**
 * Shows edits, sends them, at most one a display frame for each thing edited, and follows each until its pixels are on
 * screen.
 */
export class EditDesk {
  private drafts = new Map<string, Draft>();
  private pending = new Map<number, Pending>(); // by ticket
  private nextTicket = 1;
  private scheduled = false;
  private lastFlushMs = -Infinity;

  constructor(private readonly hooks: DeskHooks) {}

  /** One edit; a later one of the same fields of the same thing replaces it while it waits for the display frame. */
  set(label: string, edit: Edit): void {
    const key = editKey(label, edit);
    const inputMs = this.drafts.get(key)?.inputMs ?? this.hooks.now();
    const message = { op: 'set', ...edit } as Outgoing;
    this.hooks.show(edit);
    this.drafts.set(key, { label, edit, message, inputMs, camera: false });
    this.schedule();
  }

  /** The view; callers pace it themselves. */
  camera(view: View): void {
    const edit: Edit = { target: 'camera', view };
    this.hooks.show(edit);
    this.send({
      label: 'Camera',
      edit,
      message: { op: 'camera', ...view } as Outgoing,
      inputMs: this.hooks.now(),
      camera: true,
    });
  }

  /** True while camera edits are on their way: the server's view is then older than ours. */
  cameraPending(): boolean {
    return [...this.pending.values()].some((p) => p.draft.camera && p.cost === null);
  }

  /** True when all that was edited is on the screen, or has no picture to wait for. */
  settled(): boolean {
    return this.drafts.size === 0 && this.pending.size === 0;
  }

  /**
   * A description as it will be once the server has taken all that was edited here. The server answers in the order in
   * which it works: a description holds the edits whose acknowledgement came before it, and none of the others.
   */
  ahead(scene: SceneMessage): SceneMessage {
    const unanswered = [...this.pending.values()].filter((p) => p.cost === null).map((p) => p.draft);
    return [...unanswered, ...this.drafts.values()].reduce((s, draft) => withEdit(s, draft.edit), scene);
  }

  onSent(ticket: number, seq: number | null, reason = ''): void {
    const entry = this.pending.get(ticket);
    if (!entry) return;
    entry.seq = seq;
    if (seq === null) this.finish(ticket, { kind: 'unsent', message: `not sent: ${reason}` });
  }

  onAck(ack: Ack): void {
    const found = this.bySeq(ack.seq);
    if (!found) return;
    const [ticket, entry] = found;
    entry.cost = ack.cost;
    entry.sceneRevision = ack.sceneRevision;
    if (ack.cost === 'none' || ack.superseded) this.finish(ticket, { kind: 'applied', cost: ack.cost });
    else
      this.hooks.onOutcome({ label: entry.draft.label, camera: entry.draft.camera, kind: 'applied', cost: ack.cost });
  }

  /** True when the error was about an edit of ours. */
  onError(error: ErrorMessage): boolean {
    const found = error.seq === undefined ? null : this.bySeq(error.seq);
    if (!found) return false;
    const where = error.place ? ` (${error.place})` : '';
    this.finish(found[0], { kind: 'failed', message: `${error.message}${where}` });
    return true;
  }

  /** Settles every edit that this picture shows, and returns the latencies [ms]. */
  onFrame(frame: FrameReport): number[] {
    if (frame.dropped) return [];
    const latencies: number[] = [];
    for (const [ticket, entry] of this.pending) {
      if (!isShown(entry, frame.header)) continue;
      const latencyMs = frame.presentedMs - entry.draft.inputMs;
      latencies.push(latencyMs);
      this.finish(ticket, { kind: 'applied', latencyMs, ...(entry.cost ? { cost: entry.cost } : {}) });
    }
    return latencies;
  }

  /** The connection is gone; nobody will answer what was under way. */
  onDisconnected(): void {
    this.drafts.clear();
    for (const ticket of [...this.pending.keys()]) {
      this.finish(ticket, { kind: 'failed', message: 'the connection broke before the server answered' });
    }
  }

  private schedule(): void {
    if (this.scheduled) return;
    this.scheduled = true;
    this.hooks.requestFrame((nowMs) => this.flush(nowMs));
  }

  private flush(nowMs: number): void {
    this.scheduled = false;
    if (nowMs - this.lastFlushMs < kMinFlushMs) {
      this.schedule();
      return;
    }
    this.lastFlushMs = nowMs;
    const drafts = [...this.drafts.values()];
    this.drafts.clear();
    for (const draft of drafts) this.send(draft);
  }

  private send(draft: Draft): void {
    const ticket = this.nextTicket++;
    this.pending.set(ticket, { draft, seq: null, cost: null, sceneRevision: 0 });
    this.hooks.post(ticket, draft.message);
  }

  private bySeq(seq: number): [number, Pending] | null {
    return [...this.pending].find(([, entry]) => entry.seq === seq) ?? null;
  }

  private finish(ticket: number, outcome: Omit<Outcome, 'label' | 'camera'>): void {
    const entry = this.pending.get(ticket);
    this.pending.delete(ticket);
    if (entry) this.hooks.onOutcome({ label: entry.draft.label, camera: entry.draft.camera, ...outcome });
  }
}
