import type { ConnectionState, FrameReport } from '../channel';
import { isLossless, isMoving } from '../frame_flags';
import type { Model } from '../state/model';
import { h, setText } from '../ui/dom';

const kWords: Record<ConnectionState['kind'], string> = {
  connecting: 'Connecting',
  connected: 'Connected',
  reconnecting: 'Reconnecting',
  refused: 'Refused',
  paused: 'Paused',
};

/** The badges of the bar: how the connection stands, and how far the picture is. */
export class Bar {
  private readonly retry: HTMLButtonElement;

  constructor(
    private readonly connection: HTMLElement,
    private readonly phase: HTMLElement,
    model: Model,
    retry: () => void,
  ) {
    this.retry = h('button', { class: 'retry', onClick: retry, hidden: true }, 'Retry now');
    connection.after(this.retry);
    model.on('connection', (state) => this.showConnection(state));
    this.showConnection(model.connection);
  }

  showFrame({ header }: FrameReport): void {
    const words = isMoving(header) ? 'moving' : header.phase;
    this.phase.dataset['state'] = words;
    setText(this.phase, isLossless(header) ? `${words}, lossless` : words);
  }

  private showConnection(state: ConnectionState): void {
    this.connection.dataset['state'] = state.kind;
    setText(this.connection, kWords[state.kind]);
    this.connection.title = 'reason' in state ? state.reason : '';
    this.retry.hidden = state.kind !== 'reconnecting' && state.kind !== 'refused';
    if (state.kind !== 'connected') {
      setText(this.phase, '');
      delete this.phase.dataset['state'];
    }
  }
}
