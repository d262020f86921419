import { describe, expect, it } from 'vitest';
import { directionOf, watchGestures } from '../src/panels/history_controls';

function watchedWindow() {
  const root = new EventTarget();
  let ends = 0;
  watchGestures(root, () => void ends++);
  /** How many gestures an event with these fields ends. */
  return (type: string, fields: object = {}): number => {
    const before = ends;
    const values = Object.entries(fields).map(([name, value]) => [name, { value }]);
    root.dispatchEvent(Object.defineProperties(new Event(type), Object.fromEntries(values)));
    return ends - before;
  };
}

describe('watchGestures', () => {
  it('ends them with the pointer, and with what is chosen or typed', () => {
    const endsOf = watchedWindow();
    expect([endsOf('pointerup'), endsOf('pointercancel')]).toEqual([1, 1]);
    expect([endsOf('change', { target: { type: 'text' } }), endsOf('change', { target: {} })]).toEqual([1, 1]);
  });

  it('takes what a held key does to a slider for one gesture', () => {
    const endsOf = watchedWindow();
    expect(endsOf('keydown', { key: 'ArrowRight', repeat: false })).toBe(1);
    for (let i = 0; i < 3; i++) {
      expect(endsOf('change', { target: { type: 'range' } })).toBe(0);
      expect(endsOf('keydown', { key: 'ArrowRight', repeat: true })).toBe(0);
    }
    expect(endsOf('keyup', { key: 'ArrowRight' })).toBe(1);
  });

  it('takes the next press for another gesture, also where no keyup is told of', () => {
    const endsOf = watchedWindow();
    expect(endsOf('keydown', { key: 'Meta', repeat: false })).toBe(0);
    expect(endsOf('keydown', { key: 'ArrowUp', repeat: false })).toBe(1);
    expect(endsOf('keydown', { key: 'ArrowUp', repeat: true })).toBe(0);
    expect(endsOf('keydown', { key: 'ArrowUp', repeat: false })).toBe(1);
    expect(endsOf('keyup', { key: 'Meta' })).toBe(0);
  });
});

describe('the keys', () => {
  const press = (key: string, held: Partial<KeyboardEvent>) =>
    directionOf({ key, ctrlKey: false, metaKey: false, shiftKey: false, altKey: false, ...held });
  it('are those of every other program', () => {
    expect([press('z', { ctrlKey: true }), press('z', { metaKey: true })]).toEqual(['undo', 'undo']);
    expect([press('Z', { ctrlKey: true, shiftKey: true }), press('y', { ctrlKey: true })]).toEqual(['redo', 'redo']);
    expect([press('z', {}), press('z', { ctrlKey: true, altKey: true }), press('x', { ctrlKey: true })]).toEqual([
      null,
      null,
      null,
    ]);
  });
});
