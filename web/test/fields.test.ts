import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { numberField } from '../src/ui/fields';
import { FakeElement, stubDocument } from './fake_dom';

/** A field from 0 that shows 0.5, and what it told of. */
function makeField(maximum = 1) {
  const told: number[] = [];
  const field = numberField({ label: 'Roughness', minimum: 0, maximum, onInput: (value) => void told.push(value) });
  const [entry, slider] = (field.element as unknown as FakeElement).all('input') as [FakeElement, FakeElement];
  const drag = (value: number) => {
    slider.value = String(value * 1000);
    slider.fire('input');
  };
  /** Types and commits a text, and tells whether that is marked as invalid. */
  const type = (text: string) => {
    entry.value = text;
    entry.fire('input');
    entry.fire('change');
    return entry.getAttribute('aria-invalid');
  };
  field.set(0.5);
  return { field, told, entry, slider, drag, type, shown: () => [entry.value, Number(slider.value) / 1000] };
}

describe('numberField', () => {
  beforeEach(stubDocument);
  afterEach(() => vi.unstubAllGlobals());

  it.each(['pointerup', 'pointercancel', 'lostpointercapture'])(
    'keeps the slider under the hand, and shows with %s what it was given last',
    (end) => {
      const { field, told, slider, drag, shown } = makeField();
      slider.fire('pointerdown', { button: 0 });
      drag(0.8);
      field.set(0.8);
      field.set(0.5); // the server refused it
      expect([told, shown()]).toEqual([[0.8], ['0.8', 0.8]]);
      slider.fire(end);
      expect(shown()).toEqual(['0.5', 0.5]);
    },
  );

  it('stays where the hand left the slider when nothing else came', () => {
    const { slider, drag, shown } = makeField();
    slider.fire('pointerdown', { button: 0 });
    drag(0.8);
    slider.fire('pointerup');
    expect(shown()).toEqual(['0.8', 0.8]);
  });

  it.each([
    ['1.5', 1.5],
    ['1,5', 1.5],
    ['0,125', 0.125],
    ['12,3456', 12.3456],
    ['1500', 1500],
  ])('takes %s for %d', (text, value) => {
    const { told, type } = makeField(1e6);
    expect(type(text)).toBeNull();
    expect(told).toEqual([value]);
  });

  it.each(['1,500', '-12,000', '1,500.5', '1,234,567'])('does not guess what %s means', (text) => {
    const { told, entry, type } = makeField(1e6);
    expect(type(text)).toBe('true');
    expect(entry.title).toMatch(/^Ambiguous/);
    expect(told).toEqual([]);
  });

  it('tells the range of what is outside it', () => {
    const { told, entry, type } = makeField();
    expect([type('3'), entry.title, told]).toEqual(['true', 'A number from 0 to 1', []]);
    entry.fire('keydown', { key: 'Escape' });
    expect([entry.value, entry.getAttribute('aria-invalid'), entry.title]).toEqual(['0.5', null, '']);
  });

  it('is not held by a button that drags nothing', () => {
    const { field, slider, shown } = makeField();
    slider.fire('pointerdown', { button: 2 });
    field.set(0.25);
    expect(shown()).toEqual(['0.25', 0.25]);
  });
});
