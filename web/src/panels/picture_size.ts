import type { Edit } from '../protocol/messages.gen';
import type { Model } from '../state/model';
import { h } from '../ui/dom';
import { selectField } from '../ui/fields';

const kSides = [256, 384, 512, 768, 1024];
const kLeastSide = 16;
const kUsualMost = 1024;
// A window that is being resized gets a new picture when it has been still for so long.
const kSettleMs = 250;

/** Choices that follow the window, by their share of its sides. */
const kFollowing: Record<string, { share: number; title: string }> = {
  half: { share: 0.5, title: 'Half the window' },
  window: { share: 1, title: 'The whole window' },
};

interface Size {
  width: number;
  height: number;
}

export interface SizeActions {
  edit(label: string, edit: Edit): void;
  /** An edit that nobody made by hand. */
  follow(label: string, edit: Edit): void;
  /** Size of the stage in device pixels. */
  stageSize(): Size;
  onWindowResize(callback: () => void): void;
}

const wordOf = ({ width, height }: Size): string => `${width}x${height}`;

/** A share of the stage, or as much of it as the longest side allows; the shape stays. */
export function shareOfStage(stage: Size, share: number, most: number): Size {
  const scale = Math.min(share, most / Math.max(stage.width, stage.height));
  const side = (pixels: number) => Math.max(kLeastSide, Math.round(pixels * scale));
  return { width: side(stage.width), height: side(stage.height) };
}

/** The list of picture sizes. A share of the window is kept as the window changes, until another size is chosen. */
export class PictureSize {
  readonly element: HTMLElement;
  private readonly select: HTMLSelectElement;
  private listed = '';
  private following: string | null = null;
  private asked = '';
  /** The window came to rest while nobody could be asked for a picture of its size. */
  private overdue = false;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly model: Model,
    private readonly actions: SizeActions,
  ) {
    this.element = selectField('Picture size', [], (value) => this.choose(value)).element;
    this.select = this.element.querySelector('select')!;
    actions.onWindowResize(() => this.followSoon());
    model.on('scene', ({ cause }) => {
      if (cause === 'joined' && this.overdue) this.followSoon();
    });
  }

  show(size: Size): void {
    const now = wordOf(size);
    if (now !== this.asked) this.following = null; // somebody else chose it, or it was undone
    this.list(now);
    const shown = this.following ?? now;
    if (this.select.value !== shown) this.select.value = shown;
  }

  private list(now: string): void {
    const sizes = kSides.filter((side) => side <= this.most()).map((side) => wordOf({ width: side, height: side }));
    const values = [...new Set([now, ...sizes])];
    if (values.join() === this.listed) return;
    this.listed = values.join();
    const option = (value: string, title: string) => h('option', { value }, title);
    this.select.replaceChildren(
      ...values.map((value) => option(value, value.replace('x', ' × '))),
      ...Object.entries(kFollowing).map(([value, { title }]) => option(value, title)),
    );
  }

  private most(): number {
    return this.model.hello?.limits.maxImageSide ?? kUsualMost;
  }

  private choose(value: string): void {
    this.following = value in kFollowing ? value : null;
    const [width = 0, height = 0] = value.split('x').map(Number);
    const size = this.sizeToFollow() ?? { width, height };
    this.asked = wordOf(size);
    this.actions.edit('Picture size', { target: 'image', ...size });
  }

  private followSoon(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.follow(), kSettleMs);
  }

  private follow(): void {
    const size = this.sizeToFollow();
    this.overdue = size !== null && !this.model.connected();
    if (!size || this.overdue || wordOf(size) === this.asked) return;
    this.asked = wordOf(size);
    this.actions.follow('Picture size', { target: 'image', ...size });
  }

  /** The chosen share of the window as it is now; null where a fixed size was chosen. */
  private sizeToFollow(): Size | null {
    const chosen = this.following === null ? undefined : kFollowing[this.following];
    return chosen ? shareOfStage(this.actions.stageSize(), chosen.share, this.most()) : null;
  }
}
