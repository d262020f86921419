import type { FrameHeader, ServerHello, Status } from '../protocol/messages.gen';
import type { Model } from '../state/model';
import type { Statistics } from '../state/statistics';
import { nowMs } from '../clock';
import { h, setText } from '../ui/dom';
import { formatBytes, formatCount, formatInterval, formatMilliseconds, formatNumber } from '../ui/format';
import { ErrorPlot } from '../ui/plot';

const kRows = [
  'Samples per pixel',
  'Steps',
  'Pixels gathered',
  'Estimated error',
  'Edit to pixels',
  'Frames',
  'Received',
  'Dropped',
  'Frame',
  'Rays',
  'Discarded samples',
] as const;
type Row = (typeof kRows)[number];

const kMostDiscarded = 1e-5; // share of samples over which something is wrong

/** Figures of the picture and of the way that it came, redrawn at most four times a second. */
export class StatsPanel {
  private readonly values = new Map<Row, HTMLElement>();
  private readonly plot = new ErrorPlot();
  private readonly stages = h('div', { class: 'stages' });
  private readonly ran = h('p', { class: 'facts' });
  private readonly leftOut = h('p', { class: 'facts' });
  private readonly device = h('p', { class: 'facts' });
  private readonly memory = h('p', { class: 'facts' });
  private readonly times = h('p', { class: 'facts' });
  private readonly figures = h('p', { class: 'facts' });

  constructor(
    root: HTMLElement,
    private readonly model: Model,
    private readonly statistics: Statistics,
  ) {
    const list = h('dl', { class: 'figures' });
    for (const name of kRows) {
      const value = h('dd', {}, '–');
      this.values.set(name, value);
      list.append(h('div', {}, h('dt', {}, name), value));
    }
    root.append(
      h('h3', {}, 'Error over time'),
      this.plot.element,
      list,
      this.device,
      h(
        'details',
        { class: 'more', open: true },
        h('summary', {}, 'Where the time went'),
        this.stages,
        this.times,
        this.figures,
        this.ran,
        this.leftOut,
        this.memory,
      ),
    );
    setInterval(() => this.refresh(), 250);
  }

  private refresh(): void {
    const { hello, status } = this.model;
    const header = this.statistics.last?.header;
    if (header) this.showPicture(header);
    this.showTransport(header);
    if (status) this.showStatus(status);
    if (header && hello) this.showStages(header, hello);
    if (hello) setText(this.device, `${hello.device}, ${hello.server}`);
    this.plot.show(this.statistics.errorPoints);
  }

  private set(row: Row, text: string): void {
    const element = this.values.get(row);
    if (element) setText(element, text);
  }

  private showPicture(header: FrameHeader): void {
    this.set('Samples per pixel', formatNumber(header.meanSamples, 4));
    this.set('Steps', formatCount(header.steps));
    this.set('Pixels gathered', `${formatNumber(header.gatheredShare * 100, 3)} %`);
    this.set('Estimated error', formatInterval(header.estimatedError, header.errorLow, header.errorHigh));
  }

  private showTransport(header: FrameHeader | undefined): void {
    const s = this.statistics;
    const at = nowMs();
    const p95 = s.latencyQuantile(0.95);
    this.set(
      'Edit to pixels',
      Number.isFinite(p95) ? `${formatMilliseconds(s.lastLatency())} (p95 ${formatMilliseconds(p95)})` : '–',
    );
    this.set('Frames', `${formatNumber(s.framesPerSecond(at), 3)} /s, ${formatCount(s.presented)} shown`);
    this.set('Received', `${formatBytes(s.bytesPerSecond(at))}/s of ${formatBytes(s.bytes)}`);
    this.set('Dropped', `${formatCount(header?.replaced ?? 0)} at the server, ${formatCount(s.dropped)} here`);
    if (!header || !s.last) return;
    const how = header.quality > 0 ? `${header.encoding} q${header.quality}` : header.encoding;
    const divided = header.imageWidth < header.width ? ` from ${header.imageWidth} × ${header.imageHeight}` : '';
    this.set('Frame', `${header.fullWidth} × ${header.fullHeight}${divided}, ${how}, ${formatBytes(s.last.bytes)}`);
  }

  private showStatus(status: Status): void {
    this.set('Rays', status.idle ? 'at rest' : `${formatNumber(status.raysPerSecond / 1e6, 3)} M/s`);
    const share = `${formatNumber(status.discardedShare, 2)} of all`;
    this.set('Discarded samples', `${formatCount(status.discardedSamples)}, ${share}`);
    this.values.get('Discarded samples')?.classList.toggle('bad', status.discardedShare > kMostDiscarded);
    setText(this.ran, status.ran.length > 0 ? `Ran: ${status.ran.join(', ')}` : '');
    setText(this.leftOut, status.leftOut.length > 0 ? `Left out: ${status.leftOut.join(', ')}` : '');
    const memory = Object.entries(status.memory).map(([owner, bytes]) => `${owner} ${formatBytes(bytes)}`);
    setText(this.memory, memory.length > 0 ? `Memory: ${memory.join(', ')}` : '');
    const times = Object.entries(status.stageMs).map(([stage, ms]) => `${stage} ${formatMilliseconds(ms)}`);
    setText(this.times, times.length > 0 ? `Since the restart: ${times.join(', ')}` : '');
    const figures = Object.entries(status.figures).map(
      ([name, value]) => `${name} ${Number.isInteger(value) ? formatCount(value) : formatNumber(value, 3)}`,
    );
    setText(this.figures, figures.length > 0 ? `Figures: ${figures.join(', ')}` : '');
  }

  private showStages(header: FrameHeader, hello: ServerHello): void {
    const times: [string, number][] = hello.stages
      .slice(0, header.stageCount)
      .map((name, i) => [name, header.stageMs[i] ?? 0]);
    times.push(['encode', header.encodeMs], ['decode', this.statistics.last?.decodeMs ?? 0]);
    const longest = Math.max(...times.map(([, ms]) => ms), 1e-6);
    this.stages.replaceChildren(
      ...times.map(([name, ms]) => {
        const bar = h('span', { class: 'bar' });
        bar.style.width = `${(100 * ms) / longest}%`;
        return h(
          'div',
          { class: 'stage-row' },
          h('span', { class: 'name' }, name),
          h('span', { class: 'track' }, bar),
          h('span', { class: 'ms' }, formatMilliseconds(ms)),
        );
      }),
    );
  }
}
