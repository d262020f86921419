import type { Edit, EditableField, SceneMessage, ServerHello } from '../protocol/messages.gen';
import type { Model } from '../state/model';
import { h, setText } from '../ui/dom';
import { numberField, selectField, type Field } from '../ui/fields';
import { titleFromName } from '../ui/format';
import { announcedField, parameterField, type WireValue } from './announced_fields';
import { PictureSize, type SizeActions } from './picture_size';

const kDegrees = 180 / Math.PI;

export interface RenderActions extends SizeActions {
  setFieldOfView(yfov: number): void;
  saveExr(): void;
  savePng(): void;
}

/** How the picture is made and shown: technique and its parameters, exposure and tone map, lens, size, and saving. */
export class RenderPanel {
  private resolve = new Map<string, Field<WireValue>>();
  private technique: Field<string> | null = null;
  private parameters = new Map<string, Field<number>>();
  private readonly size: PictureSize;
  private readonly fieldOfView: Field<number>;
  private readonly about = h('p', { class: 'facts' });
  private readonly knobs = h('div', { class: 'knobs' });
  private knobsOf = '';

  constructor(
    private readonly root: HTMLElement,
    private readonly model: Model,
    private readonly actions: RenderActions,
  ) {
    this.fieldOfView = numberField({
      label: 'Field of view',
      unit: '°',
      minimum: 1,
      maximum: 170,
      softMinimum: 10,
      softMaximum: 100,
      onInput: (degrees) => actions.setFieldOfView(degrees / kDegrees),
    });
    this.size = new PictureSize(model, actions);
    model.on('hello', (hello) => this.build(hello));
    model.on('scene', (scene) => this.refresh(scene));
    model.on('edited', (edit) => {
      if (!model.scene) return;
      // A gesture edits the camera with every display frame.
      if (edit.target === 'camera') this.showLens(model.scene);
      else this.refresh(model.scene);
    });
  }

  private build(hello: ServerHello): void {
    const resolveFields = hello.editable.find((e) => e.target === 'resolve')?.fields ?? [];
    this.resolve.clear();
    const shown = resolveFields.map((field) => this.resolveField(field, hello));
    this.technique = selectField(
      'Technique',
      hello.techniques.map((t) => ({ value: t.name, title: t.title, description: t.description })),
      (name) => this.actions.edit('Technique', { target: 'technique', technique: name }),
    );
    this.knobsOf = '';
    this.root.replaceChildren(
      h(
        'section',
        { class: 'sheet', 'aria-label': 'Display settings' },
        h('h3', {}, 'Display'),
        ...shown,
        this.fieldOfView.element,
        this.size.element,
      ),
      h(
        'section',
        { class: 'sheet', 'aria-label': 'Technique and its parameters' },
        h('h3', {}, 'Technique'),
        this.technique.element,
        this.about,
        this.knobs,
      ),
      h(
        'div',
        { class: 'buttons' },
        h('button', { onClick: () => this.actions.saveExr() }, 'Save EXR'),
        h('button', { onClick: () => this.actions.savePng() }, 'Save PNG'),
      ),
    );
    if (this.model.scene) this.refresh(this.model.scene);
  }

  private resolveField(field: EditableField, hello: ServerHello): HTMLElement | null {
    const choices = field.name === 'toneMap' ? { choices: [...hello.toneMaps] } : {};
    const input = announcedField({ ...field, ...choices }, (value) =>
      this.actions.edit(titleFromName(field.name), { target: 'resolve', [field.name]: value } as Edit),
    );
    if (!input) return null;
    this.resolve.set(field.name, input);
    return input.element;
  }

  private refresh(scene: SceneMessage): void {
    for (const [name, field] of this.resolve) {
      const value = (scene.resolve as unknown as Record<string, WireValue>)[name];
      if (value !== undefined) field.set(value);
    }
    this.showLens(scene);
    this.size.show(scene);
    this.showTechnique(scene);
  }

  private showLens({ view }: SceneMessage): void {
    if (view.yfov !== undefined) this.fieldOfView.set(Number((view.yfov * kDegrees).toFixed(3)));
    this.fieldOfView.element.hidden = view.perspective === false;
  }

  private showTechnique(scene: SceneMessage): void {
    this.technique?.set(scene.technique);
    const info = this.model.hello?.techniques.find((t) => t.name === scene.technique);
    setText(
      this.about,
      info ? info.description + (info.biased ? ' Biased: it converges to something near the truth.' : '') : '',
    );
    if (info && this.knobsOf !== info.name) {
      this.knobsOf = info.name;
      this.parameters.clear();
      this.knobs.replaceChildren(
        ...info.parameters.map((parameter) => {
          const field = parameterField(parameter, (value) =>
            this.actions.edit(titleFromName(parameter.name), {
              target: 'technique',
              parameters: { [parameter.name]: value },
            }),
          );
          field.set(parameter.default);
          this.parameters.set(parameter.name, field);
          return field.element;
        }),
      );
    }
    for (const [name, field] of this.parameters) {
      const value = scene.parameters[name];
      if (value !== undefined) field.set(value);
    }
  }
}
