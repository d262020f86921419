const kMinGapMs = 2000;

/** Speaks to screen readers through a polite live region, at most once in two seconds; the newest waiting text wins. */
export class Announcer {
  private waiting: string | null = null;
  private lastMs = -Infinity;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly speak: (text: string) => void,
    private readonly now: () => number = () => performance.now(),
  ) {}

  say(text: string): void {
    this.waiting = text;
    if (this.timer !== undefined) return;
    const wait = this.lastMs + kMinGapMs - this.now();
    if (wait <= 0) this.flush();
    else this.timer = setTimeout(() => this.flush(), wait);
  }

  private flush(): void {
    this.timer = undefined;
    if (this.waiting === null) return;
    this.lastMs = this.now();
    const text = this.waiting;
    this.waiting = null;
    this.speak(text);
  }
}
