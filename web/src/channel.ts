/** What the page and the stream worker tell each other. Nothing else passes between them. */
import type { ClientMessage, FrameHeader, ServerMessage } from './protocol/messages.gen';

/** A message for the server; the worker gives it its `seq`, which rises over everything that a connection carries. */
type WithoutSeq<M> = M extends unknown ? Omit<M, 'seq'> : never;
export type Outgoing = WithoutSeq<ClientMessage>;

export type ConnectionState =
  | { kind: 'connecting' }
  | { kind: 'connected' }
  /** Lost, or never reached: tried again at `retryAtMs` (absolute). */
  | { kind: 'reconnecting'; attempt: number; retryAtMs: number; reason: string }
  /** The server answered and said no. `retryAtMs` is absent where asking again is pointless. */
  | { kind: 'refused'; reason: string; retryAtMs?: number }
  /** The page is hidden for long: the server need not work for nobody. */
  | { kind: 'paused' };

/** A part of the canvas [pixel]. */
export interface Area {
  x: number;
  y: number;
  width: number;
  height: number;
}

export interface PixelHash {
  width: number;
  height: number;
  sha256: string;
  distinct: number;
}

/** A picture that is on the canvas now, or was dropped. Times are absolute milliseconds (see clock.ts). */
export interface FrameReport {
  header: FrameHeader;
  dropped: boolean;
  receivedMs: number;
  presentedMs: number;
  decodeMs: number;
  bytes: number;
}

export type ToWorker =
  | { type: 'start'; canvas: OffscreenCanvas; url: string; token: string | null; client: string }
  | { type: 'send'; ticket: number; message: Outgoing }
  | { type: 'retry' }
  | { type: 'hidden'; hidden: boolean }
  | { type: 'png'; ticket: number }
  | { type: 'hash'; ticket: number }
  | { type: 'mean'; ticket: number; area: Area };

export type ToPage =
  | { type: 'state'; state: ConnectionState }
  | { type: 'message'; message: ServerMessage }
  /** The message with this ticket left as `seq`; or, with null, did not leave, for `reason`. */
  | { type: 'sent'; ticket: number; seq: number | null; reason?: string }
  | { type: 'frame'; frame: FrameReport }
  | { type: 'fault'; text: string }
  | { type: 'file'; header: FrameHeader; bytes: Uint8Array }
  /** The canvas as a PNG file; null where that failed. */
  | { type: 'png'; ticket: number; png: Blob | null }
  | { type: 'hash'; ticket: number; hash: PixelHash }
  | { type: 'mean'; ticket: number; rgb: [number, number, number] };
