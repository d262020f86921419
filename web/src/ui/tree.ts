import { h } from './dom';

export interface TreeItem {
  key: string;
  label: string;
  /** Short word behind the label: "spot", "mesh". */
  note?: string | undefined;
  children: TreeItem[];
  /** Shown folded until somebody unfolds it or selects something in it. */
  foldedAtFirst?: boolean;
}

/** An ARIA tree: one tab stop, arrows walk and fold, Enter and Space select. */
export class Tree {
  readonly element: HTMLUListElement;
  private items: readonly TreeItem[] = [];
  private rows = new Map<string, HTMLLIElement>();
  private folded = new Set<string>();
  private known = new Set<string>();
  private selected: string | null = null;

  constructor(
    label: string,
    private readonly onSelect: (key: string) => void,
  ) {
    this.element = h('ul', { role: 'tree', class: 'tree', 'aria-label': label });
    this.element.addEventListener('keydown', (event) => this.handleKey(event));
    this.element.addEventListener('click', (event) => this.handleClick(event));
  }

  /** Shows items unless they look as those shown; folding, selection and focus stay where their keys still exist. */
  show(items: readonly TreeItem[]): void {
    if (sameItems(items, this.items)) return;
    this.items = items;
    const focused = this.keyOf(document.activeElement);
    this.rows.clear();
    this.element.replaceChildren(...items.map((item) => this.makeRow(item, 1)));
    const selected = this.markSelected();
    const again = focused === null ? undefined : this.rows.get(focused);
    this.setTabStop(again ?? (selected ? visibleAt(selected) : (this.visibleRows()[0] ?? null)));
    again?.focus({ preventScroll: true });
  }

  /** Marks `key` as selected without telling anybody; a row that was not before becomes the tab stop and is shown. */
  select(key: string | null): void {
    if (key === this.selected) return;
    this.selected = key;
    const row = this.markSelected();
    if (row) this.unfoldAbove(row);
    this.setTabStop(row ?? this.visibleRows()[0] ?? null);
    row?.scrollIntoView({ block: 'nearest' });
  }

  private markSelected(): HTMLLIElement | undefined {
    for (const [key, row] of this.rows) row.setAttribute('aria-selected', String(key === this.selected));
    return this.selected === null ? undefined : this.rows.get(this.selected);
  }

  private makeRow(item: TreeItem, level: number): HTMLLIElement {
    const hasChildren = item.children.length > 0;
    if (item.foldedAtFirst && !this.known.has(item.key)) this.folded.add(item.key);
    this.known.add(item.key);
    const row = h(
      'li',
      {
        role: 'treeitem',
        'data-key': item.key,
        'aria-level': level,
        tabindex: -1,
        'aria-expanded': hasChildren ? String(!this.folded.has(item.key)) : null,
      },
      h(
        'div',
        { class: 'row' },
        h('span', { class: 'twist', 'aria-hidden': 'true' }, hasChildren ? '▾' : ''),
        h('span', { class: 'label' }, item.label),
        item.note ? h('span', { class: 'note' }, item.note) : null,
      ),
    );
    if (hasChildren)
      row.append(h('ul', { role: 'group' }, ...item.children.map((child) => this.makeRow(child, level + 1))));
    this.rows.set(item.key, row);
    return row;
  }

  private keyOf(target: EventTarget | Element | null): string | null {
    const row = target instanceof Element ? target.closest<HTMLElement>('[role=treeitem]') : null;
    return row && this.element.contains(row) ? (row.dataset['key'] ?? null) : null;
  }

  private handleClick(event: MouseEvent): void {
    const key = this.keyOf(event.target);
    const row = key === null ? undefined : this.rows.get(key);
    if (key === null || !row) return;
    this.setTabStop(row);
    row.focus({ preventScroll: true });
    if ((event.target as Element).classList.contains('twist'))
      this.fold(row, row.getAttribute('aria-expanded') === 'true');
    else this.choose(key);
  }

  private handleKey(event: KeyboardEvent): void {
    const key = this.keyOf(event.target);
    const row = key === null ? undefined : this.rows.get(key);
    if (key === null || !row) return;
    const visible = this.visibleRows();
    const at = visible.indexOf(row);
    const expanded = row.getAttribute('aria-expanded');
    const moves: Record<string, () => void> = {
      ArrowDown: () => this.focusRow(visible[at + 1]),
      ArrowUp: () => this.focusRow(visible[at - 1]),
      Home: () => this.focusRow(visible[0]),
      End: () => this.focusRow(visible.at(-1)),
      ArrowRight: () =>
        expanded === 'false' ? this.fold(row, false) : expanded === 'true' ? this.focusRow(visible[at + 1]) : undefined,
      ArrowLeft: () => (expanded === 'true' ? this.fold(row, true) : this.focusRow(parentRow(row))),
      Enter: () => this.choose(key),
      ' ': () => this.choose(key),
    };
    const move = moves[event.key];
    if (!move) return;
    event.preventDefault();
    move();
  }

  private choose(key: string): void {
    this.select(key);
    this.onSelect(key);
  }

  private fold(row: HTMLLIElement, folded: boolean): void {
    const key = row.dataset['key'] ?? '';
    row.setAttribute('aria-expanded', String(!folded));
    if (folded) this.folded.add(key);
    else this.folded.delete(key);
  }

  private unfoldAbove(row: HTMLLIElement): void {
    for (let up = parentRow(row); up; up = parentRow(up)) this.fold(up, false);
  }

  private visibleRows(): HTMLLIElement[] {
    return [...this.rows.values()]
      .filter((row) => !row.parentElement?.closest('[aria-expanded=false]'))
      .sort(byDocument);
  }

  private focusRow(row: HTMLLIElement | undefined): void {
    if (!row) return;
    this.setTabStop(row);
    row.focus();
  }

  private setTabStop(row: HTMLLIElement | null): void {
    for (const other of this.rows.values()) other.tabIndex = -1;
    if (row) row.tabIndex = 0;
  }
}

function parentRow(row: HTMLLIElement): HTMLLIElement | undefined {
  return row.parentElement?.closest<HTMLLIElement>('[role=treeitem]') ?? undefined;
}

/** The row, or that of the outermost folded group that hides it. */
function visibleAt(row: HTMLLIElement): HTMLLIElement {
  let shown = row;
  for (let up = parentRow(row); up; up = parentRow(up)) if (up.getAttribute('aria-expanded') === 'false') shown = up;
  return shown;
}

/** True when both lists look the same. */
export function sameItems(a: readonly TreeItem[], b: readonly TreeItem[]): boolean {
  return (
    a.length === b.length &&
    a.every((item, i) => {
      const other = b[i];
      return (
        other !== undefined &&
        item.key === other.key &&
        item.label === other.label &&
        item.note === other.note &&
        sameItems(item.children, other.children)
      );
    })
  );
}

function byDocument(a: Node, b: Node): number {
  return a.compareDocumentPosition(b) & Node.DOCUMENT_POSITION_FOLLOWING ? -1 : 1;
}
