import type { FrameHeader, ServerMessage } from '../protocol/messages.gen';
import { isFinal } from '../frame_flags';
import { isOlder, type Revisions } from './decode_queue';

// A server that says nothing for so long, not even pong, is taken for lost although TCP still hopes.
const kSilentMs = 15_000;
// The slowest link that is borne with.
const kSlowBytesPerMs = 65_536 / 1000;
// A lossless picture is hardly ever longer than its pixels.
const kPixelBytes = 3;

/** How long the server may be silent: behind a large message nothing else arrives until its last byte is here. */
export class Patience {
  private fileBytes = 0;
  private converged = false;
  private pixels = 0;
  private told: Revisions = { sceneRevision: 0, viewRevision: 0 };
  private shown: FrameHeader | null = null;

  onMessage(message: ServerMessage): void {
    switch (message.op) {
      case 'saved':
        this.fileBytes += message.bytes;
        break;
      case 'status':
        this.converged = message.phase === 'converged';
        break;
      case 'scene':
        this.pixels = message.width * message.height;
        this.hearOf(message);
        break;
      case 'ack':
        this.hearOf(message);
        break;
    }
  }

  onFrame(header: FrameHeader): void {
    if (header.kind === 'file') {
      this.fileBytes = 0;
      return;
    }
    this.shown = header;
    this.pixels = header.fullWidth * header.fullHeight;
  }

  limitMs(): number {
    const pictureBytes = this.awaitsLossless() ? this.pixels * kPixelBytes : 0;
    return kSilentMs + (this.fileBytes + pictureBytes) / kSlowBytesPerMs;
  }

  private hearOf({ sceneRevision, viewRevision }: Revisions): void {
    this.told = { sceneRevision, viewRevision };
  }

  /** Of a converged film a lossless picture follows, unless it is here and nothing changed since. */
  private awaitsLossless(): boolean {
    return this.converged && !(this.shown && isFinal(this.shown) && !isOlder(this.shown, this.told));
  }
}
