import type { EditHistory } from '../state/edit_history';
import { h } from '../ui/dom';

export type Direction = 'undo' | 'redo';

const kModifiers = ['Control', 'Meta', 'Shift', 'Alt'];

/** What a key press asks for; null when it is for something else. */
export function directionOf(
  event: Pick<KeyboardEvent, 'key' | 'ctrlKey' | 'metaKey' | 'shiftKey' | 'altKey'>,
): Direction | null {
  if (event.altKey || !(event.ctrlKey || event.metaKey)) return null;
  const key = event.key.toLowerCase();
  if (key === 'z') return event.shiftKey ? 'redo' : 'undo';
  return key === 'y' && !event.shiftKey ? 'redo' : null;
}

/** There the browser undoes what was typed. */
const isTextField = (element: Element | null): boolean => element?.matches('input[type=text], textarea') ?? false;

const isModifier = (event: Event): boolean => kModifiers.includes((event as KeyboardEvent).key);
const isSlider = (target: EventTarget | null): boolean => (target as HTMLInputElement | null)?.type === 'range';

/** Calls `end` where what comes next is no part of what the hand did so far. */
export function watchGestures(root: EventTarget, end: () => void): void {
  for (const type of ['pointerup', 'pointercancel']) root.addEventListener(type, end);
  // A slider changes with every repeat of a held key.
  root.addEventListener('change', (event) => {
    if (!isSlider(event.target)) end();
  });
  root.addEventListener('keyup', (event) => {
    if (!isModifier(event)) end();
  });
  // A Mac tells of no keyup while Meta is held. Capture comes before the edit that the key makes.
  const capture = true;
  root.addEventListener(
    'keydown',
    (event) => {
      if (!(event as KeyboardEvent).repeat && !isModifier(event)) end();
    },
    capture,
  );
}

/** The buttons and keys that undo and redo edits; also tells the history where gestures end. */
export class HistoryControls {
  private readonly undo: HTMLButtonElement;
  private readonly redo: HTMLButtonElement;

  constructor(
    root: HTMLElement,
    private readonly history: EditHistory,
    travel: (direction: Direction) => void,
  ) {
    this.undo = h('button', { onClick: () => travel('undo') }, 'Undo');
    this.redo = h('button', { onClick: () => travel('redo') }, 'Redo');
    root.append(h('span', { class: 'history', role: 'group', 'aria-label': 'Edits' }, this.undo, this.redo));
    window.addEventListener('keydown', (event) => {
      const direction = isTextField(document.activeElement) ? null : directionOf(event);
      if (!direction) return;
      event.preventDefault();
      travel(direction);
    });
    watchGestures(window, () => history.endGesture());
    this.show();
  }

  show(): void {
    describe(this.undo, 'Undo', 'Ctrl+Z', this.history.nextUndo());
    describe(this.redo, 'Redo', 'Ctrl+Shift+Z', this.history.nextRedo());
  }
}

/** A button with nothing to do stays where the focus is. */
function describe(button: HTMLButtonElement, verb: string, keys: string, label: string | null): void {
  button.setAttribute('aria-disabled', String(label === null));
  button.title = label === null ? `Nothing to ${verb.toLowerCase()}` : `${verb}: ${label} (${keys})`;
}
