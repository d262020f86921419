import type { FrameHeader } from '../protocol/messages.gen';
import { isFull, isLossless } from '../frame_flags';

/** An image frame as it came, not decoded yet. */
export interface EncodedFrame {
  header: FrameHeader;
  payload: Uint8Array;
  receivedMs: number; // absolute, of the last byte
}

export interface DecodeHooks<Picture> {
  decode(frame: EncodedFrame): Promise<Picture>;
  /** Resolves when the picture is on the canvas. */
  present(frame: EncodedFrame, picture: Picture): Promise<void>;
  discard(picture: Picture): void;
  /** Every frame ends here exactly once, shown or dropped. */
  acknowledge(frame: EncodedFrame, dropped: boolean): void;
  failed(frame: EncodedFrame, reason: unknown): void;
}

export type Revisions = Pick<FrameHeader, 'sceneRevision' | 'viewRevision'>;

/** True when `a` shows an older scene or an older view than `b`. */
export const isOlder = (a: Revisions, b: Revisions): boolean =>
  a.sceneRevision < b.sceneRevision || a.viewRevision < b.viewRevision;

/** True when nothing is lost by showing `next` without ever having shown `waiting`. */
export function replaces(next: FrameHeader, waiting: FrameHeader): boolean {
  if (!isFull(next) || isOlder(next, waiting)) return false;
  const sameState = !isOlder(waiting, next);
  return !(sameState && isLossless(waiting) && !isLossless(next));
}

/**
 * Decodes one frame at a time; of those that wait only the newest is kept. What is on screen never goes back to an
 * older revision, and a frame that is not shown is acknowledged as dropped.
 */
export class DecodeQueue<Picture> {
  private waiting: EncodedFrame[] = [];
  private running = false;
  private epoch = 0;
  private shown: FrameHeader | null = null;

  constructor(private readonly hooks: DecodeHooks<Picture>) {}

  push(frame: EncodedFrame): void {
    const kept: EncodedFrame[] = [];
    for (const other of this.waiting) {
      if (replaces(frame.header, other.header)) this.hooks.acknowledge(other, true);
      else kept.push(other);
    }
    this.waiting = [...kept, frame];
    if (!this.running) void this.run();
  }

  /** A new connection: frames of the old one are forgotten, and its revisions mean nothing any more. */
  reset(): void {
    this.epoch++;
    this.waiting = [];
    this.shown = null;
  }

  private async run(): Promise<void> {
    this.running = true;
    for (let frame = this.waiting.shift(); frame; frame = this.waiting.shift()) await this.handle(frame);
    this.running = false;
  }

  private async handle(frame: EncodedFrame): Promise<void> {
    const epoch = this.epoch;
    if (this.shown && isOlder(frame.header, this.shown)) {
      this.hooks.acknowledge(frame, true);
      return;
    }
    try {
      const picture = await this.hooks.decode(frame);
      if (epoch !== this.epoch) {
        this.hooks.discard(picture);
        return;
      }
      this.shown = frame.header;
      await this.hooks.present(frame, picture);
      if (epoch === this.epoch) this.hooks.acknowledge(frame, false);
    } catch (reason) {
      if (epoch !== this.epoch) return;
      this.hooks.failed(frame, reason);
      this.hooks.acknowledge(frame, true);
    }
  }
}
