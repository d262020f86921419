import type { FrameReport } from '../channel';
import type { FrameHeader, Status } from '../protocol/messages.gen';
import type { ErrorPoint } from '../ui/plot';

const kWindowMs = 2000;
const kMaxPoints = 600;
const kMaxLatencies = 120;
// A load counts as an edit, and sampling begins only when it is done.
const kLongestSinceEditMs = 10_000;

interface Sample {
  atMs: number;
  bytes: number;
  shown: boolean;
}

/** When the newest edit that a picture shows was made, which restarted the sampling. */
const editedMs = ({ presentedMs, header }: FrameReport): number =>
  presentedMs - Math.min(kLongestSinceEditMs, Math.max(0, header.msSinceEdit));

/** Figures gathered from presented frames: rates over two seconds, latencies, and the error since the restart. */
export class Statistics {
  last: FrameReport | null = null;
  presented = 0;
  dropped = 0;
  bytes = 0;
  errorPoints: ErrorPoint[] = [];
  private samples: Sample[] = [];
  private latencies: number[] = [];
  private restartMs: number | null = null; // when sampling began

  onFrame(frame: FrameReport): void {
    this.bytes += frame.bytes;
    this.samples.push({ atMs: frame.presentedMs, bytes: frame.bytes, shown: !frame.dropped });
    this.samples = this.samples.filter((s) => s.atMs > frame.presentedMs - kWindowMs);
    if (frame.dropped) {
      this.dropped++;
      return;
    }
    this.presented++;
    if (this.restartMs === null || this.isRestart(frame.header)) {
      this.restartMs = editedMs(frame);
      this.errorPoints = [];
    }
    this.addErrorPoint(frame, this.restartMs);
    this.last = frame;
  }

  /** Who joins sees pictures of a restart that was long before, maybe with edits since that restarted nothing. */
  onStatus({ secondsSinceRestart }: Status, atMs: number): void {
    if (!this.last) this.restartMs = atMs - secondsSinceRestart * 1000;
  }

  onLatencies(latencies: readonly number[]): void {
    this.latencies = [...this.latencies, ...latencies].slice(-kMaxLatencies);
  }

  /** A new connection: steps and revisions start anew. */
  onConnected(): void {
    this.last = null;
    this.restartMs = null;
    this.errorPoints = [];
  }

  framesPerSecond(atMs: number): number {
    return this.recent(atMs).filter((s) => s.shown).length / (kWindowMs / 1000);
  }

  bytesPerSecond(atMs: number): number {
    return this.recent(atMs).reduce((sum, s) => sum + s.bytes, 0) / (kWindowMs / 1000);
  }

  /** Quantile of the newest latencies from input to pixels [ms]; NaN before the first. */
  latencyQuantile(share: number): number {
    const sorted = [...this.latencies].sort((a, b) => a - b);
    return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] ?? NaN;
  }

  lastLatency(): number {
    return this.latencies.at(-1) ?? NaN;
  }

  private recent(atMs: number): Sample[] {
    return this.samples.filter((s) => s.atMs > atMs - kWindowMs && s.atMs <= atMs);
  }

  private isRestart(header: FrameHeader): boolean {
    if (!this.last) return false;
    const before = this.last.header;
    if (header.sceneRevision !== before.sceneRevision || header.viewRevision !== before.viewRevision) return true;
    if (header.steps < before.steps || header.meanSamples < before.meanSamples) return true;
    // While a parameter is dragged no revision rises, and hardly a pass is finished. 0: nobody ever edited anything.
    return header.steps < 2 && header.msSinceEdit > 0;
  }

  private addErrorPoint(frame: FrameReport, restartMs: number): void {
    const { estimatedError: error, errorLow: low, errorHigh: high } = frame.header;
    const seconds = (frame.presentedMs - restartMs) / 1000;
    if (!Number.isFinite(error) || error <= 0 || seconds <= 0) return;
    this.errorPoints.push({ seconds, error, low, high });
    if (this.errorPoints.length > kMaxPoints) this.errorPoints = thin(this.errorPoints);
  }
}

/** Every second point of the older half goes: on a logarithmic axis the late points stand densest. */
export function thin(points: readonly ErrorPoint[]): ErrorPoint[] {
  return points.filter((_, i) => i === 0 || i === points.length - 1 || i % 2 === 0);
}
