import { h, uniqueId } from './dom';
import { formatNumber } from './format';

/** A labelled input that shows the server's value and tells about the person's edits. */
export interface Field<T> {
  readonly element: HTMLElement;
  /** Shows `value`, unless the person is just typing here. */
  set(value: T): void;
}

export interface NumberOptions {
  label: string;
  unit?: string | undefined;
  minimum?: number | undefined;
  maximum?: number | undefined;
  /** Where the slider begins and ends, should that be narrower than what may be typed. */
  softMinimum?: number | undefined;
  softMaximum?: number | undefined;
  integer?: boolean;
  /** Slider positions follow the logarithm; for ranges over many decades. */
  logarithmic?: boolean;
  slider?: boolean;
  description?: string | undefined;
  onInput(value: number): void;
}

const kSliderSteps = 1000;
const kArrowDirections: Record<string, 1 | -1> = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1 };
const isBusy = (input: HTMLInputElement): boolean =>
  document.activeElement === input && input.dataset['dirty'] === 'true';

export function labelText(label: string, unit?: string | undefined): HTMLElement {
  const shown = unit && unit !== '1' ? h('span', { class: 'unit' }, ` ${unit}`) : null;
  return h('span', { class: 'name' }, label, shown);
}

// Whether these commas part decimals or thousands nobody can tell; "0,125" and "1,5" can only be decimals.
const kAmbiguous = /^[+-]?[1-9]\d{0,2}(,\d{3})+(\.\d+)?$/;

/** Reads a typed number; null when it is not one, may be one of two, or lies outside the range. */
function parseTyped(text: string, options: NumberOptions): number | null {
  const typed = text.trim();
  const value = Number(typed.replace(',', '.'));
  if (typed === '' || kAmbiguous.test(typed) || !Number.isFinite(value)) return null;
  if (options.integer && !Number.isInteger(value)) return null;
  if (value < (options.minimum ?? -Infinity) || value > (options.maximum ?? Infinity)) return null;
  return value;
}

/** What is wrong with a typed text that is no number here. */
function faultOf(text: string, options: NumberOptions): string {
  if (kAmbiguous.test(text.trim())) return 'Ambiguous: write a point before decimals, and nothing between thousands';
  const kind = options.integer ? 'A whole number' : 'A number';
  return `${kind} from ${options.minimum ?? '−∞'} to ${options.maximum ?? '∞'}`;
}

interface NumberInput {
  input: HTMLInputElement;
  shown(): number;
  set(value: number): void;
}

function numberInput(options: NumberOptions, label: string): NumberInput {
  const input = h('input', {
    type: 'text',
    inputmode: 'decimal',
    class: 'number',
    'aria-label': label,
    autocomplete: 'off',
  });
  let shown = NaN;
  const show = (value: number) => {
    shown = value;
    input.value = formatNumber(value, 5);
    input.dataset['dirty'] = 'false';
    input.removeAttribute('aria-invalid');
    input.title = '';
  };
  const commit = () => {
    if (input.dataset['dirty'] !== 'true') return;
    const value = parseTyped(input.value, options);
    if (value === null) {
      input.setAttribute('aria-invalid', 'true');
      input.title = faultOf(input.value, options);
      return;
    }
    show(value);
    options.onInput(value);
  };
  input.addEventListener('input', () => {
    input.dataset['dirty'] = 'true';
  });
  input.addEventListener('change', commit);
  input.addEventListener('keydown', (event) => {
    if (event.key === 'Enter') commit();
    if (event.key === 'Escape') show(shown);
    if (event.key !== 'ArrowUp' && event.key !== 'ArrowDown') return;
    event.preventDefault();
    const step = nudgeStep(shown, options) * (event.key === 'ArrowUp' ? 1 : -1) * (event.shiftKey ? 10 : 1);
    const value = clamp(shown + step, options);
    show(value);
    options.onInput(value);
  });
  return {
    input,
    shown: () => shown,
    set: (value) => {
      if (!isBusy(input)) show(value);
    },
  };
}

const clamp = (value: number, o: NumberOptions): number =>
  Math.min(o.maximum ?? Infinity, Math.max(o.minimum ?? -Infinity, value));

/** One arrow key press: a hundredth of the range, or of the value's decade where there is no range. */
function nudgeStep(value: number, options: NumberOptions): number {
  if (options.integer) return 1;
  const range =
    (options.softMaximum ?? options.maximum ?? Infinity) - (options.softMinimum ?? options.minimum ?? -Infinity);
  if (Number.isFinite(range) && range < 1000) return Math.pow(10, Math.floor(Math.log10(range / 20)));
  return Math.pow(10, Math.floor(Math.log10(Math.max(Math.abs(value), 0.01))) - 1);
}

/** Slider position of a value and back; both in 0..kSliderSteps. And where an arrow key takes a whole number. */
export function sliderScale(options: Omit<NumberOptions, 'label' | 'onInput'>) {
  const low = options.softMinimum ?? options.minimum ?? 0;
  const high = options.softMaximum ?? options.maximum ?? 1;
  // Zero cannot be reached on a logarithm: a slope that is linear below a thousandth of the range joins both.
  const knee = (high - low) / 1000;
  const forward = (v: number) => (options.logarithmic ? Math.log1p((v - low) / knee) : v - low);
  const span = forward(high) || 1;
  const clip = (v: number) => Math.min(high, Math.max(low, v));
  const positionOf = (value: number) => Math.round((forward(clip(value)) / span) * kSliderSteps);
  const valueAt = (position: number) => {
    const f = (position / kSliderSteps) * span;
    const value = low + (options.logarithmic ? Math.expm1(f) * knee : f);
    return options.integer ? Math.round(value) : Number(value.toPrecision(4));
  };
  /** The next whole number, or a step of the slider where that is farther. */
  const nextInteger = (value: number, direction: 1 | -1) => {
    const stepped = valueAt(positionOf(value) + direction);
    return clip(direction * (stepped - value) > 1 ? stepped : value + direction);
  };
  return { positionOf, valueAt, nextInteger };
}

export function numberField(options: NumberOptions): Field<number> {
  const id = uniqueId('field');
  const entry = numberInput(options, options.label);
  entry.input.id = id;
  const row = h(
    'div',
    { class: 'field', title: options.description },
    h('label', { for: id }, labelText(options.label, options.unit)),
    entry.input,
  );
  if (options.slider === false) return { element: row, set: entry.set };

  const scale = sliderScale(options);
  const slider = h('input', {
    type: 'range',
    min: 0,
    max: kSliderSteps,
    step: 1,
    'aria-label': `${options.label}, slider`,
  });
  const describeSlider = (value: number) => {
    slider.setAttribute('aria-valuetext', `${formatNumber(value)} ${options.unit ?? ''}`.trim());
    slider.style.setProperty('--fill', `${(100 * Number(slider.value)) / kSliderSteps}%`);
  };
  const moveSlider = (value: number) => {
    slider.value = String(scale.positionOf(value));
    describeSlider(value);
  };
  const show = (value: number) => {
    entry.set(value);
    moveSlider(value);
  };
  slider.addEventListener('input', () => {
    const value = scale.valueAt(Number(slider.value));
    entry.set(value);
    describeSlider(value);
    options.onInput(value);
  });
  if (options.integer)
    slider.addEventListener('keydown', (event) => {
      const direction = kArrowDirections[event.key];
      if (!direction || event.altKey || event.ctrlKey || event.metaKey) return;
      event.preventDefault();
      const value = scale.nextInteger(entry.shown(), direction);
      show(value);
      options.onInput(value);
    });
  entry.input.addEventListener('change', () => {
    const value = parseTyped(entry.input.value, options);
    if (value !== null) moveSlider(value);
  });
  let dragging = false;
  let withheld: number | null = null; // must not move the slider under the hand, and is shown once that lets go
  const release = () => {
    dragging = false;
    if (withheld !== null) show(withheld);
    withheld = null;
  };
  slider.addEventListener('pointerdown', (event) => {
    dragging = event.button === 0;
  });
  for (const end of ['pointerup', 'pointercancel', 'lostpointercapture']) slider.addEventListener(end, release);
  row.append(slider);
  row.classList.add('with-slider');
  return {
    element: row,
    set(value) {
      if (dragging) withheld = value;
      else show(value);
    },
  };
}

/** Components of a vector side by side. */
export function vectorField(
  options: Omit<NumberOptions, 'onInput'> & { components: readonly string[]; onInput(value: number[]): void },
): Field<readonly number[]> {
  let current: number[] = options.components.map(() => 0);
  const entries = options.components.map((component, i) =>
    numberInput(
      {
        ...options,
        onInput: (value) => {
          current = current.map((old, k) => (k === i ? value : old));
          options.onInput(current);
        },
      },
      `${options.label} ${component}`,
    ),
  );
  const boxes = entries.map((entry, i) =>
    h(
      'span',
      { class: 'component' },
      h('span', { class: 'axis', 'aria-hidden': 'true' }, options.components[i]),
      entry.input,
    ),
  );
  const row = h(
    'div',
    { class: 'field vector', role: 'group', 'aria-label': options.label, title: options.description },
    labelText(options.label, options.unit),
    h('div', { class: 'components' }, ...boxes),
  );
  return {
    element: row,
    set(value) {
      current = [...value];
      entries.forEach((entry, i) => entry.set(value[i] ?? 0));
    },
  };
}

export interface Choice {
  value: string;
  title: string;
  description?: string | undefined;
}

export function selectField(
  label: string,
  choices: readonly Choice[],
  onInput: (value: string) => void,
): Field<string> {
  const id = uniqueId('select');
  const options = choices.map((c) => h('option', { value: c.value, title: c.description }, c.title));
  const select = h('select', { id, onChange: () => onInput(select.value) }, ...options);
  return {
    element: h('div', { class: 'field choice' }, h('label', { for: id }, labelText(label)), select),
    set(value) {
      select.value = value;
    },
  };
}

/** A line of text; it counts when it is committed, not while it is typed. */
export function textField(options: {
  label: string;
  description?: string | undefined;
  onInput(value: string): void;
}): Field<string> {
  const id = uniqueId('text');
  let shown = '';
  const show = (value: string) => {
    shown = value;
    input.value = value;
    input.dataset['dirty'] = 'false';
  };
  const input = h('input', {
    type: 'text',
    id,
    autocomplete: 'off',
    spellcheck: 'false',
    onInput: () => {
      input.dataset['dirty'] = 'true';
    },
    onChange: () => {
      show(input.value.trim());
      options.onInput(shown);
    },
    onKeydown: (event: KeyboardEvent) => {
      if (event.key === 'Escape') show(shown);
    },
  });
  return {
    element: h(
      'div',
      { class: 'field text', title: options.description },
      h('label', { for: id }, labelText(options.label)),
      input,
    ),
    set(value) {
      if (!isBusy(input)) show(value);
    },
  };
}

export function checkField(
  label: string,
  onInput: (value: boolean) => void,
  description?: string | undefined,
): Field<boolean> {
  const id = uniqueId('check');
  const box = h('input', { type: 'checkbox', id, onChange: () => onInput(box.checked) });
  return {
    element: h('div', { class: 'field check', title: description }, h('label', { for: id }, labelText(label)), box),
    set(value) {
      box.checked = value;
    },
  };
}
