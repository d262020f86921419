import type { Vec3 } from '../math/vec3';
import { anglesOf, quatFromEuler, type Quat } from '../math/rotation';
import type { EditableField, TechniqueParameter } from '../protocol/messages.gen';
import { colorField } from '../ui/color_field';
import { checkField, numberField, selectField, textField, vectorField, type Field } from '../ui/fields';
import { titleFromName } from '../ui/format';

const kDegrees = 180 / Math.PI;
// A slider from zero over so wide a range is of use only on a logarithm.
const kWideRange = 5;
const kUnbounded = 1e6;

/** What an announced field's value is on the wire. */
export type WireValue = number | string | readonly number[];

/** The input for a field as the server announced it; null for kinds that a panel of their own shows. */
export function announcedField(field: EditableField, onInput: (value: WireValue) => void): Field<WireValue> | null {
  switch (field.kind) {
    case 'number':
      return announcedNumber(field, onInput) as Field<WireValue>;
    case 'choice':
      return selectField(
        titleFromName(field.name),
        (field.choices ?? []).map((value) => ({ value, title: titleFromName(value) })),
        onInput,
      ) as Field<WireValue>;
    case 'color':
      return announcedColor(field, onInput) as Field<WireValue>;
    case 'color-alpha':
      return announcedColorAlpha(field, onInput);
    case 'vector':
      return vectorField({ ...rangeOf(field), components: ['X', 'Y', 'Z'], onInput }) as Field<WireValue>;
    case 'text':
      return textField({ ...rangeOf(field), onInput }) as Field<WireValue>;
    case 'quaternion':
      return announcedRotation(field, onInput);
    default:
      return null;
  }
}

/** The input for a technique's parameter; its value always travels as a number. */
export function parameterField(parameter: TechniqueParameter, onInput: (value: number) => void): Field<number> {
  const label = titleFromName(parameter.name);
  const description = `${parameter.description} A change costs: ${parameter.cost}.`;
  if (parameter.type === 'boolean') {
    const check = checkField(label, (on) => onInput(on ? 1 : 0), description);
    return { element: check.element, set: (value) => check.set(value !== 0) };
  }
  const { minimum, maximum, unit } = parameter;
  const wide = minimum >= 0 && maximum / Math.max(minimum, 1) > 100;
  return numberField({
    label,
    unit,
    description,
    minimum,
    maximum,
    integer: parameter.type === 'integer',
    logarithmic: wide,
    onInput,
  });
}

function rangeOf(field: EditableField) {
  return {
    label: titleFromName(field.name),
    unit: field.unit,
    description: field.description,
    minimum: field.minimum,
    maximum: field.maximum,
    softMinimum: field.softMinimum,
    softMaximum: field.softMaximum,
  };
}

/** Angles are shown in degrees; on the wire they are radians. */
function announcedNumber(field: EditableField, onInput: (value: number) => void): Field<number> {
  const range = rangeOf(field);
  const inDegrees = field.unit === 'rad';
  const factor = inDegrees ? kDegrees : 1;
  const times = (value: number | undefined) => (value === undefined ? undefined : value * factor);
  const low = range.softMinimum ?? range.minimum ?? -Infinity;
  const high = range.softMaximum ?? range.maximum ?? Infinity;
  const shown = numberField({
    ...range,
    unit: inDegrees ? '°' : field.unit,
    minimum: times(range.minimum),
    maximum: times(range.maximum),
    softMinimum: times(range.softMinimum),
    softMaximum: times(range.softMaximum),
    slider: Number.isFinite(low) && high < kUnbounded,
    logarithmic: low === 0 && high > kWideRange && !inDegrees,
    onInput: (value) => onInput(value / factor),
  });
  return { element: shown.element, set: (value) => shown.set(value * factor) };
}

function announcedColor(field: EditableField, onInput: (value: Vec3) => void): Field<Vec3> {
  const { label, unit, description } = rangeOf(field);
  return colorField({
    label,
    unit,
    description,
    maximum: field.maximum ?? kUnbounded,
    softMaximum: field.softMaximum,
    onInput,
  });
}

function announcedColorAlpha(field: EditableField, onInput: (value: readonly number[]) => void): Field<WireValue> {
  let value: readonly number[] = [1, 1, 1, 1];
  const color = announcedColor(field, ([r, g, b]) => onInput((value = [r, g, b, value[3] ?? 1])));
  const alpha = numberField({
    label: 'Alpha',
    minimum: 0,
    maximum: 1,
    onInput: (a) => onInput((value = [...value.slice(0, 3), a])),
  });
  color.element.append(alpha.element);
  return {
    element: color.element,
    set(wire) {
      value = wire as readonly number[];
      color.set([value[0] ?? 0, value[1] ?? 0, value[2] ?? 0]);
      alpha.set(value[3] ?? 1);
    },
  };
}

function announcedRotation(field: EditableField, onInput: (value: Quat) => void): Field<WireValue> {
  let shown: Vec3 = [0, 0, 0];
  const angles = vectorField({
    label: titleFromName(field.name),
    unit: '°',
    description: 'about x, then y, then z of the parent',
    components: ['X', 'Y', 'Z'],
    softMinimum: -180,
    softMaximum: 180,
    onInput: ([x = 0, y = 0, z = 0]) => {
      shown = [x, y, z];
      onInput(quatFromEuler(shown));
    },
  });
  return {
    element: angles.element,
    set(wire) {
      shown = anglesOf(wire as unknown as Quat, shown);
      angles.set(shown);
    },
  };
}
