import { h } from './dom';
import { formatNumber } from './format';

/** One point of the convergence: seconds since the restart, estimated relMSE with its interval. */
export interface ErrorPoint {
  seconds: number;
  error: number;
  low: number;
  high: number;
}

interface Axis {
  low: number;
  high: number;
} // decades

const kPad = { left: 38, right: 8, top: 8, bottom: 22 };
const kInk = {
  line: '#8fb8ff',
  band: 'rgba(143,184,255,0.18)',
  grid: 'rgba(255,255,255,0.07)',
  text: '#9aa4b2',
  guide: 'rgba(255,207,112,0.55)',
};

/** Whole decades that hold all values; at least one. */
export function decades(values: readonly number[]): Axis {
  const logs = values.filter((v) => v > 0 && Number.isFinite(v)).map(Math.log10);
  if (logs.length === 0) return { low: -1, high: 0 };
  const low = Math.floor(Math.min(...logs));
  return { low, high: Math.max(low + 1, Math.ceil(Math.max(...logs))) };
}

/** Error over time, both axes logarithmic, with a guide of slope -1: relMSE of an unbiased estimate falls as 1/time. */
export class ErrorPlot {
  readonly element: HTMLCanvasElement;
  private points: readonly ErrorPoint[] = [];
  private newest: ErrorPoint | undefined;
  private queued = false;

  constructor() {
    this.element = h('canvas', {
      class: 'plot',
      role: 'img',
      'aria-label': 'Estimated error over time since the last restart',
    });
    new ResizeObserver(() => this.queue()).observe(this.element);
  }

  show(points: readonly ErrorPoint[]): void {
    const newest = points.at(-1);
    if (newest === this.newest && points.length > 0) return;
    this.newest = newest;
    this.points = points.filter((p) => p.seconds > 0 && p.error > 0 && Number.isFinite(p.error));
    const last = this.points.at(-1);
    this.element.setAttribute(
      'aria-label',
      last
        ? `Estimated error over time: ${formatNumber(last.error, 3)} after ${formatNumber(last.seconds, 3)} seconds`
        : 'Estimated error over time: no estimate yet',
    );
    this.queue();
  }

  private queue(): void {
    if (this.queued) return;
    this.queued = true;
    requestAnimationFrame(() => {
      this.queued = false;
      this.draw();
    });
  }

  private draw(): void {
    const { clientWidth: width, clientHeight: height } = this.element;
    const ratio = window.devicePixelRatio || 1;
    if (width === 0 || height === 0) return;
    this.element.width = Math.round(width * ratio);
    this.element.height = Math.round(height * ratio);
    const ink = this.element.getContext('2d');
    if (!ink) return;
    ink.scale(ratio, ratio);
    ink.font = '10px system-ui, sans-serif';

    const xAxis = decades(this.points.map((p) => p.seconds));
    const yAxis = decades(this.points.map((p) => p.error));
    const x = (v: number) =>
      kPad.left + ((Math.log10(v) - xAxis.low) / (xAxis.high - xAxis.low)) * (width - kPad.left - kPad.right);
    const y = (v: number) =>
      height -
      kPad.bottom -
      ((Math.log10(Math.max(v, 1e-30)) - yAxis.low) / (yAxis.high - yAxis.low)) * (height - kPad.top - kPad.bottom);
    drawGrid(ink, xAxis, yAxis, x, y, width, height);
    if (this.points.length === 0) {
      ink.fillStyle = kInk.text;
      ink.textAlign = 'center';
      ink.fillText('no error estimate yet', (kPad.left + width) / 2, height / 2);
      return;
    }
    ink.save();
    ink.beginPath();
    ink.rect(kPad.left, kPad.top, width - kPad.left - kPad.right, height - kPad.top - kPad.bottom);
    ink.clip();
    drawGuide(ink, this.points, x, y);
    drawCurve(ink, this.points, x, y);
    ink.restore();
  }
}

type Scale = (v: number) => number;

function drawGrid(
  ink: CanvasRenderingContext2D,
  xAxis: Axis,
  yAxis: Axis,
  x: Scale,
  y: Scale,
  width: number,
  height: number,
): void {
  ink.strokeStyle = kInk.grid;
  ink.fillStyle = kInk.text;
  ink.lineWidth = 1;
  const line = (x0: number, y0: number, x1: number, y1: number) => {
    ink.beginPath();
    ink.moveTo(x0, y0);
    ink.lineTo(x1, y1);
    ink.stroke();
  };
  ink.textAlign = 'center';
  for (let d = xAxis.low; d <= xAxis.high; d++) {
    line(x(10 ** d), kPad.top, x(10 ** d), height - kPad.bottom);
    const atEnd = d === xAxis.high ? -8 : 0;
    ink.fillText(formatNumber(10 ** d, 1) + (d === xAxis.high ? ' s' : ''), x(10 ** d) + atEnd, height - 8);
  }
  ink.textAlign = 'right';
  const step = Math.ceil((yAxis.high - yAxis.low) / 6);
  for (let d = yAxis.low; d <= yAxis.high; d += step) {
    line(kPad.left, y(10 ** d), width - kPad.right, y(10 ** d));
    ink.fillText(d >= -2 && d <= 3 ? String(10 ** d) : `1e${d}`, kPad.left - 5, y(10 ** d) + 3);
  }
}

function drawGuide(ink: CanvasRenderingContext2D, points: readonly ErrorPoint[], x: Scale, y: Scale): void {
  const first = points[0]!;
  const last = points.at(-1)!;
  ink.strokeStyle = kInk.guide;
  ink.setLineDash([3, 4]);
  ink.beginPath();
  ink.moveTo(x(first.seconds), y(first.error));
  ink.lineTo(x(last.seconds), y((first.error * first.seconds) / last.seconds));
  ink.stroke();
  ink.setLineDash([]);
}

function drawCurve(ink: CanvasRenderingContext2D, points: readonly ErrorPoint[], x: Scale, y: Scale): void {
  const banded = points.filter((p) => p.low > 0 && Number.isFinite(p.high));
  ink.fillStyle = kInk.band;
  ink.beginPath();
  banded.forEach((p) => ink.lineTo(x(p.seconds), y(p.high)));
  [...banded].reverse().forEach((p) => ink.lineTo(x(p.seconds), y(p.low)));
  ink.fill();

  ink.strokeStyle = kInk.line;
  ink.lineWidth = 1.6;
  ink.beginPath();
  points.forEach((p) => ink.lineTo(x(p.seconds), y(p.error)));
  ink.stroke();
  const last = points.at(-1)!;
  ink.fillStyle = kInk.line;
  ink.beginPath();
  ink.arc(x(last.seconds), y(last.error), 2.5, 0, 2 * Math.PI);
  ink.fill();
}
