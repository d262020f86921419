import type { Area, ConnectionState, FrameReport, Outgoing, PixelHash, ToPage, ToWorker } from './channel';
import type { FrameHeader, ServerMessage } from './protocol/messages.gen';

export interface LinkHooks {
  onState(state: ConnectionState): void;
  onMessage(message: ServerMessage): void;
  onSent(ticket: number, seq: number | null, reason: string): void;
  onFrame(frame: FrameReport): void;
  onFile(header: FrameHeader, bytes: Uint8Array): void;
  onFault(text: string): void;
}

/** The page's end of the stream worker. */
export class StreamLink {
  private readonly worker: Worker;
  private readonly answers = new Map<number, (answer: never) => void>();
  private nextQuestion = 1;

  constructor(
    canvas: HTMLCanvasElement,
    url: string,
    token: string | null,
    private readonly hooks: LinkHooks,
  ) {
    this.worker = new Worker(new URL('./worker/stream_worker.ts', import.meta.url), {
      type: 'module',
      name: 'limn stream',
    });
    this.worker.onmessage = ({ data }: MessageEvent<ToPage>) => this.receive(data);
    this.worker.onerror = (event) => hooks.onFault(`the stream worker failed: ${event.message}`);
    const offscreen = canvas.transferControlToOffscreen();
    this.post({ type: 'start', canvas: offscreen, url, token, client: 'limn-web 0.1' }, [offscreen]);
    document.addEventListener('visibilitychange', () => this.tellHidden());
    this.tellHidden(); // a page may open in the background
    window.addEventListener('online', () => {
      if (!document.hidden) this.retry();
    });
  }

  send(ticket: number, message: Outgoing): void {
    this.post({ type: 'send', ticket, message });
  }

  /** Tries to connect now instead of later. */
  retry(): void {
    this.post({ type: 'retry' });
  }

  /** The picture as it is shown; null where the browser cannot write it. */
  png(): Promise<Blob | null> {
    return this.ask((ticket) => ({ type: 'png', ticket }));
  }

  /** Test hook. */
  hash(): Promise<PixelHash> {
    return this.ask((ticket) => ({ type: 'hash', ticket }));
  }

  /** Test hook. */
  mean(area: Area): Promise<[number, number, number]> {
    return this.ask((ticket) => ({ type: 'mean', ticket, area }));
  }

  private tellHidden(): void {
    this.post({ type: 'hidden', hidden: document.hidden });
  }

  private ask<T>(question: (ticket: number) => ToWorker): Promise<T> {
    const ticket = this.nextQuestion++;
    return new Promise<T>((resolve) => {
      this.answers.set(ticket, resolve as (answer: never) => void);
      this.post(question(ticket));
    });
  }

  private answer(ticket: number, value: unknown): void {
    this.answers.get(ticket)?.(value as never);
    this.answers.delete(ticket);
  }

  private post(message: ToWorker, transfer: Transferable[] = []): void {
    this.worker.postMessage(message, transfer);
  }

  private receive(data: ToPage): void {
    switch (data.type) {
      case 'state':
        this.hooks.onState(data.state);
        break;
      case 'message':
        this.hooks.onMessage(data.message);
        break;
      case 'sent':
        this.hooks.onSent(data.ticket, data.seq, data.reason ?? '');
        break;
      case 'frame':
        this.hooks.onFrame(data.frame);
        break;
      case 'file':
        this.hooks.onFile(data.header, data.bytes);
        break;
      case 'fault':
        this.hooks.onFault(data.text);
        break;
      case 'png':
        this.answer(data.ticket, data.png);
        break;
      case 'hash':
        this.answer(data.ticket, data.hash);
        break;
      case 'mean':
        this.answer(data.ticket, data.rgb);
        break;
    }
  }
}
