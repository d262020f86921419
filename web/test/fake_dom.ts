import { vi } from 'vitest';

type Child = FakeElement | string;

/** As much of an element as the page's own parts need. */
export class FakeElement extends EventTarget {
  value = '';
  title = '';
  hidden = false;
  readonly dataset: Record<string, string> = {};
  readonly classes = new Set<string>();
  readonly classList = {
    add: (name: string) => void this.classes.add(name),
    toggle: (name: string, on: boolean) => void (on ? this.classes.add(name) : this.classes.delete(name)),
  };
  readonly style = { setProperty: (): void => {} };
  private readonly attributes = new Map<string, string>();
  private children: Child[] = [];

  constructor(private readonly tag: string) {
    super();
  }

  get textContent(): string {
    return this.children.map((child) => (child instanceof FakeElement ? child.textContent : child)).join('');
  }
  set textContent(text: string) {
    this.children = [text];
  }

  setAttribute(name: string, value: string): void {
    this.attributes.set(name, value);
  }
  getAttribute(name: string): string | null {
    return this.attributes.get(name) ?? null;
  }
  removeAttribute(name: string): void {
    this.attributes.delete(name);
  }

  append(...children: Child[]): void {
    this.children.push(...children);
  }
  replaceChildren(...children: Child[]): void {
    this.children = children;
  }

  /** All elements below this one that have the tag, in their order. */
  all(tag: string): FakeElement[] {
    const below = this.children.filter((child) => child instanceof FakeElement);
    return below.flatMap((child) => (child.tag === tag ? [child, ...child.all(tag)] : child.all(tag)));
  }
  querySelector(tag: string): FakeElement | null {
    return this.all(tag)[0] ?? null;
  }

  /** Lets an event with these fields happen to the element. */
  fire(type: string, fields: object = {}): void {
    this.dispatchEvent(Object.assign(new Event(type), fields));
  }
}

/** Makes fake elements where the page makes its own, until vi.unstubAllGlobals. */
export function stubDocument(): void {
  vi.stubGlobal('document', { createElement: (tag: string) => new FakeElement(tag), activeElement: null });
}
