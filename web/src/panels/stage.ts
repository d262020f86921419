import type { Model } from '../state/model';
import type { ConnectionState } from '../channel';
import { setText } from '../ui/dom';
import { nowMs } from '../clock';

export interface Rectangle {
  left: number;
  top: number;
  width: number;
  height: number;
}

/** The largest rectangle of the picture's shape inside a box, centred. */
export function fitPicture(box: Rectangle, pictureWidth: number, pictureHeight: number): Rectangle {
  const scale = Math.min(box.width / pictureWidth, box.height / pictureHeight);
  const width = pictureWidth * scale;
  const height = pictureHeight * scale;
  return { left: box.left + (box.width - width) / 2, top: box.top + (box.height - height) / 2, width, height };
}

/** The picture's pixel under a point of the window; null beside the picture. */
export function pixelAt(
  shown: Rectangle,
  pictureWidth: number,
  pictureHeight: number,
  clientX: number,
  clientY: number,
): { x: number; y: number } | null {
  const x = Math.floor(((clientX - shown.left) / shown.width) * pictureWidth);
  const y = Math.floor(((clientY - shown.top) / shown.height) * pictureHeight);
  return x >= 0 && y >= 0 && x < pictureWidth && y < pictureHeight ? { x, y } : null;
}

/** The picture's place on the page: where it is shown, whether it is stale, and the mark of the picked point. */
export class Stage {
  private size = { width: 16, height: 16 };
  private hasPicture = false;
  private connected = false;
  private retryTimer: ReturnType<typeof setInterval> | undefined;

  constructor(
    readonly element: HTMLElement,
    private readonly stale: HTMLElement,
    private readonly marker: HTMLElement,
    model: Model,
  ) {
    model.on('connection', (state) => this.showConnection(state));
  }

  /** A picture of this size was shown. */
  onPicture(width: number, height: number): void {
    this.hasPicture = true;
    this.element.classList.add('has-picture');
    this.size = { width, height };
    this.markStale(!this.connected);
  }

  aspect(): number {
    return this.size.width / this.size.height;
  }

  /** Where the picture is on the window [CSS pixel]. */
  shown(): Rectangle {
    return fitPicture(this.element.getBoundingClientRect(), this.size.width, this.size.height);
  }

  pixelAt(clientX: number, clientY: number): { x: number; y: number } | null {
    return this.hasPicture ? pixelAt(this.shown(), this.size.width, this.size.height, clientX, clientY) : null;
  }

  /** A ring at the picked pixel, which fades by itself. */
  mark(pixel: { x: number; y: number }): void {
    const shown = this.shown();
    const box = this.element.getBoundingClientRect();
    this.marker.style.left = `${shown.left - box.left + ((pixel.x + 0.5) / this.size.width) * shown.width}px`;
    this.marker.style.top = `${shown.top - box.top + ((pixel.y + 0.5) / this.size.height) * shown.height}px`;
    this.marker.hidden = false;
    this.marker.getAnimations().forEach((animation) => animation.cancel());
    this.marker.animate([{ opacity: 1 }, { opacity: 1, offset: 0.6 }, { opacity: 0 }], { duration: 1600 }).onfinish =
      () => {
        this.marker.hidden = true;
      };
  }

  private showConnection(state: ConnectionState): void {
    clearInterval(this.retryTimer);
    this.connected = state.kind === 'connected';
    this.markStale(true);
    const write = () => setText(this.stale, staleText(state, this.hasPicture));
    write();
    if ('retryAtMs' in state) this.retryTimer = setInterval(write, 250);
  }

  /** What is shown is of an older connection, or of none. */
  private markStale(stale: boolean): void {
    this.element.classList.toggle('stale', stale && this.hasPicture);
    this.stale.hidden = !stale;
  }
}

function staleText(state: ConnectionState, hasPicture: boolean): string {
  const what = hasPicture ? 'Stale picture — ' : '';
  const wait =
    'retryAtMs' in state && state.retryAtMs !== undefined ? Math.max(0, state.retryAtMs - nowMs()) / 1000 : null;
  const again = wait === null ? '' : `; trying again in ${wait.toFixed(1)} s`;
  switch (state.kind) {
    case 'connecting':
      return `${what}connecting…`;
    case 'reconnecting':
      return `${what}${state.reason}${again}`;
    case 'refused':
      return `${what}refused: ${state.reason}${again}`;
    case 'paused':
      return `${what}paused while the page was hidden`;
    case 'connected':
      return `${what}waiting for the first picture`;
  }
}
