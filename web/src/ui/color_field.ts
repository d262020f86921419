import { hexFromLinear, linearFromHex, splitStrength } from '../math/color';
import type { Vec3 } from '../math/vec3';
import { h, uniqueId } from './dom';
import { labelText, numberField, vectorField, type Field } from './fields';

export interface ColorOptions {
  label: string;
  unit?: string | undefined;
  /** Largest component that may be edited; above 1 the field gets a strength slider of its own. */
  maximum: number;
  softMaximum?: number | undefined;
  description?: string | undefined;
  onInput(linear: Vec3): void;
}

/** A colour: the picker speaks sRGB, the numbers and the server linear Rec. 709. */
export function colorField(options: ColorOptions): Field<Vec3> {
  const id = uniqueId('color');
  const bounded = options.maximum <= 1;
  let color: Vec3 = [1, 1, 1];
  let hue: Vec3 = color; // outlasts a strength of 0
  const take = (linear: Vec3) => {
    color = linear;
    hue = splitStrength(linear, hue).color;
    show();
  };
  const picker = h('input', { type: 'color', id });
  let picking = false; // its window is open: what it shows must not move under the hand
  const changed = (linear: Vec3) => {
    take(linear);
    options.onInput(linear);
  };
  const numbers = vectorField({
    label: `${options.label}, linear`,
    components: ['R', 'G', 'B'],
    minimum: 0,
    maximum: options.maximum,
    onInput: ([r = 0, g = 0, b = 0]) => changed([r, g, b]),
  });
  const strengthField = bounded
    ? null
    : numberField({
        label: 'Strength',
        minimum: 0,
        maximum: options.maximum,
        softMaximum: options.softMaximum,
        logarithmic: true,
        onInput: (strength) => {
          const [r, g, b] = hue;
          changed([r * strength, g * strength, b * strength]);
        },
      });
  const show = () => {
    const unlit = Math.max(...color) === 0;
    if (!picking) picker.value = hexFromLinear(bounded || unlit ? color : hue);
    numbers.set(color);
    strengthField?.set(splitStrength(color).strength);
  };
  picker.addEventListener('input', () => {
    picking = true;
    const linear = linearFromHex(picker.value);
    if (bounded || Math.max(...linear) === 0) {
      changed(linear);
      return;
    }
    const strength = splitStrength(color).strength || 1;
    const [r, g, b] = splitStrength(linear).color;
    changed([r * strength, g * strength, b * strength]);
  });
  picker.addEventListener('change', () => {
    picking = false;
    show();
  });
  numbers.element.classList.remove('field');
  numbers.element.querySelector('.name')?.remove();
  return {
    element: h(
      'div',
      { class: 'field color', title: options.description },
      h('label', { for: id }, labelText(options.label, options.unit && options.unit !== '1' ? options.unit : 'linear')),
      picker,
      numbers.element,
      strengthField?.element,
    ),
    set: take,
  };
}
