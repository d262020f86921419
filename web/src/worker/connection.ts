import type { ConnectionState, Outgoing } from '../channel';
import { nowMs } from '../clock';
import {
  decodeServer,
  encodeClient,
  kSubprotocol,
  ProtocolError,
  type ClientMessage,
  type FrameHeader,
  type ServerMessage,
} from '../protocol/messages.gen';
import { backoffMs } from './backoff';
import { Patience } from './patience';
import { asBearer, explainClose, probeServer } from './refusal';

const kRefusedRetryMs = 10_000;
const kHandshakeMs = 6_000;
const kPingMs = 5_000;

export interface ConnectionHooks {
  onState(state: ConnectionState): void;
  /** A new connection was made; nothing of an older one is valid any more. */
  onOpen(): void;
  onMessage(message: ServerMessage): void;
  /** Takes a binary message apart; null when it is malformed. */
  onBinary(data: ArrayBuffer): FrameHeader | null;
  onFault(text: string): void;
  /** The client's hello, without seq. */
  hello(): Outgoing;
}

/** Keeps one socket to the server: connects, says hello, reconnects with backoff, and tells honestly how it stands. */
export class Connection {
  private socket: WebSocket | null = null;
  private greeted = false;
  private seq = 0;
  private attempt = 0;
  private wakeTimer: ReturnType<typeof setTimeout> | undefined;
  private pulseTimer: ReturnType<typeof setInterval> | undefined;
  private lastHeardMs = 0;
  private patience = new Patience();
  private lastError: { code: string; message: string } | null = null;
  private paused = false;

  constructor(
    private readonly url: string,
    private readonly token: string | null,
    private readonly hooks: ConnectionHooks,
  ) {}

  /** Connects now, whatever was planned. */
  open(): void {
    this.forget();
    this.paused = false;
    this.hooks.onState({ kind: 'connecting' });
    this.seq = 0;
    this.lastError = null;
    this.patience = new Patience();
    const protocols = this.token ? [kSubprotocol, asBearer(this.token)] : [kSubprotocol];
    const socket = new WebSocket(this.url, protocols);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    let opened = false;
    socket.onopen = () => {
      opened = true;
      this.hooks.onOpen();
      this.transmit(this.hooks.hello());
    };
    socket.onmessage = (event) => this.receive(event.data as string | ArrayBuffer);
    socket.onclose = (event) => void this.lost(socket, event, opened);
    this.wakeTimer = setTimeout(() => this.abandon(), kHandshakeMs);
  }

  /** Retries at once if it waits to retry. */
  hurry(): void {
    if (!this.socket) {
      this.attempt = 0;
      this.open();
    }
  }

  /** Gives the server its time back until `hurry`. */
  pause(): void {
    this.paused = true;
    const socket = this.socket;
    if (socket && this.greeted) this.transmit({ op: 'bye' });
    this.forget();
    socket?.close(1000);
    this.hooks.onState({ kind: 'paused' });
  }

  /** Sends with the next seq and returns it; null, and nothing is sent, without a greeted connection. */
  send(message: Outgoing): number | null {
    return this.greeted ? this.transmit(message) : null;
  }

  private transmit(message: Outgoing): number | null {
    if (this.socket?.readyState !== WebSocket.OPEN) return null;
    this.socket.send(encodeClient({ ...message, seq: this.seq + 1 } as ClientMessage));
    return ++this.seq;
  }

  private receive(data: string | ArrayBuffer): void {
    this.lastHeardMs = nowMs();
    if (typeof data !== 'string') {
      const header = this.hooks.onBinary(data);
      if (header) this.patience.onFrame(header);
      return;
    }
    let message: ServerMessage;
    try {
      message = decodeServer(data);
    } catch (reason) {
      // A newer server may say things that this client does not know; the protocol lets them pass.
      if (reason instanceof ProtocolError && reason.code === 'unknown-op') return;
      this.hooks.onFault(`the server sent a message that cannot be read: ${String(reason)}`);
      return;
    }
    this.patience.onMessage(message);
    if (message.op === 'hello') this.greet();
    if (message.op === 'error') this.lastError = message;
    this.hooks.onMessage(message);
  }

  private greet(): void {
    this.greeted = true;
    this.attempt = 0;
    clearTimeout(this.wakeTimer);
    this.pulseTimer = setInterval(() => {
      if (nowMs() - this.lastHeardMs > this.patience.limitMs()) this.abandon();
      else this.transmit({ op: 'ping' });
    }, kPingMs);
    this.hooks.onState({ kind: 'connected' });
  }

  /** Gives up a socket that says nothing: its closing handshake would wait for an answer as well. */
  private abandon(): void {
    const socket = this.socket;
    this.forget();
    socket?.close();
    this.retryLater('the server fell silent');
  }

  private async lost(socket: WebSocket, event: CloseEvent, opened: boolean): Promise<void> {
    if (socket !== this.socket) return;
    const refusal = this.greeted ? null : this.lastError;
    const reason = explainClose(event.code, event.reason, this.lastError?.message ?? null);
    this.forget();
    if (!opened) {
      const said = await probeServer(this.url);
      if (this.socket || this.paused) return; // somebody hurried meanwhile
      if (said) this.refuse(said.reason, said.hopeless);
      else this.retryLater('the server cannot be reached');
    } else if (refusal && refusal.code === 'version') {
      this.refuse(refusal.message, true);
    } else {
      this.retryLater(reason);
    }
  }

  private refuse(reason: string, hopeless: boolean): void {
    if (hopeless) {
      this.hooks.onState({ kind: 'refused', reason });
      return;
    }
    this.wakeTimer = setTimeout(() => this.open(), kRefusedRetryMs);
    this.hooks.onState({ kind: 'refused', reason, retryAtMs: nowMs() + kRefusedRetryMs });
  }

  private retryLater(reason: string): void {
    const wait = backoffMs(this.attempt++);
    this.wakeTimer = setTimeout(() => this.open(), wait);
    this.hooks.onState({ kind: 'reconnecting', attempt: this.attempt, retryAtMs: nowMs() + wait, reason });
  }

  private forget(): void {
    clearTimeout(this.wakeTimer);
    clearInterval(this.pulseTimer);
    const socket = this.socket;
    this.socket = null;
    this.greeted = false;
    if (!socket) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    if (socket.readyState === WebSocket.CONNECTING) socket.close();
  }
}
