import type { FrameHeader, ServerMessage } from '../protocol/messages.gen';
import { isFinal } from '../frame_flags';
import { isOlder, type Revisions } from './decode_queue';

// A server that says nothing for so long, not even pong, is taken for lost although TCP still hopes.
const kSilentMs = 15_000;
// The slowest link that is borne with.
const kSlowBytesPerMs = 65_536 / 1000;
// A picture is hardly ever longer than this for each of its pixels: a lossless one, and one of full quality before it.
const kLosslessPixelBytes = 3;
const kPixelBytes = 1.5;
// What a description is for whose length nobody knows before it is here.
const kDescriptionMs = 60_000;

/** How long the server may be silent: behind a large message nothing else arrives until its last byte is here. */
export class Patience {
  private fileBytes = 0;
  private described = false;
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
        this.described = true;
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
    const descriptionMs = this.described ? 0 : kDescriptionMs;
    return kSilentMs + descriptionMs + (this.fileBytes + this.pictureBytes()) / kSlowBytesPerMs;
  }

  private hearOf({ sceneRevision, viewRevision }: Revisions): void {
    this.told = { sceneRevision, viewRevision };
  }

  /** Of the picture that may be on its way: none follows the final one until something changes. */
  private pictureBytes(): number {
    if (this.shown && isFinal(this.shown) && !isOlder(this.shown, this.told)) return 0;
    return this.pixels * (this.converged ? kLosslessPixelBytes : kPixelBytes);
  }
}
