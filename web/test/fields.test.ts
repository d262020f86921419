import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { numberField } from '../src/ui/fields';
import { FakeElement, stubDocument } from './fake_dom';

/** A field from 0 to 1 that shows 0.5, and what it told of. */
function makeField() {
  const told: number[] = [];
  const field = numberField({ label: 'Roughness', minimum: 0, maximum: 1, onInput: (value) => void told.push(value) });
  const [entry, slider] = (field.element as unknown as FakeElement).all('input') as [FakeElement, FakeElement];
  const drag = (value: number) => {
    slider.value = String(value * 1000);
    slider.fire('input');
  };
  field.set(0.5);
  return { field, told, entry, slider, drag, shown: () => [entry.value, Number(slider.value) / 1000] };
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

  it('is not held by a button that drags nothing', () => {
    const { field, slider, shown } = makeField();
    slider.fire('pointerdown', { button: 2 });
    field.set(0.25);
    expect(shown()).toEqual(['0.25', 0.25]);
  });
});
