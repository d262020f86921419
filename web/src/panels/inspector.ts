import type { Edit, EditableField, SceneMessage } from '../protocol/messages.gen';
import type { Model, Selection } from '../state/model';
import { h } from '../ui/dom';
import type { Field } from '../ui/fields';
import { announcedField, type WireValue } from './announced_fields';
import { nameOf } from './names';

type Item = Record<string, unknown>;

/** One thing that the inspector shows: where its values are, and how an edit of it is written. */
interface Sheet {
  title: string;
  target: Edit['target'];
  index: { [name: string]: number };
  read(scene: SceneMessage): Item | undefined;
  facts: string[];
}

interface Shown {
  sheet: Sheet;
  fields: Map<string, Field<WireValue>>;
}

// So many fields of a thing are always open; the rest wait behind "more".
const kOpenFields = 4;

/** The panel of what is selected: a sheet each for node, its light and its material, built from the announced fields. */
export class Inspector {
  private shown: Shown[] = [];
  private moreOpen = false;

  constructor(
    private readonly root: HTMLElement,
    private readonly model: Model,
    private readonly edit: (label: string, edit: Edit) => void,
  ) {
    model.on('selection', () => this.rebuild());
    model.on('hello', () => this.rebuild());
    model.on('scene', () => this.rebuildOrRefresh());
    model.on('edited', (edit) => {
      if (edit.target !== 'camera') this.refresh();
    });
    this.rebuild();
  }

  private sheets(): Sheet[] {
    const { scene, selection } = this.model;
    return scene ? sheetsOf(scene, selection) : [];
  }

  private rebuild(): void {
    const sheets = this.sheets();
    this.shown = [];
    this.root.replaceChildren();
    if (sheets.length === 0) {
      this.root.append(
        h(
          'p',
          { class: 'hint' },
          'Click something in the picture, or choose it in the list, to see what it is made of.',
        ),
      );
      return;
    }
    for (const sheet of sheets) this.root.append(this.buildSheet(sheet));
    this.refresh();
  }

  private buildSheet(sheet: Sheet): HTMLElement {
    const announced = this.model.hello?.editable.find((e) => e.target === sheet.target)?.fields ?? [];
    const item = this.model.scene ? sheet.read(this.model.scene) : undefined;
    const fields = new Map<string, Field<WireValue>>();
    const rows: HTMLElement[] = [];
    for (const field of announced) {
      if (!isOfUse(field, sheet, item)) continue;
      const input = announcedField(field, (value) => this.send(sheet, field, value));
      if (!input) continue;
      fields.set(field.name, input);
      rows.push(input.element);
    }
    this.shown.push({ sheet, fields });
    const rest = rows.splice(kOpenFields);
    const more =
      rest.length === 0
        ? null
        : h(
            'details',
            {
              class: 'more',
              open: this.moreOpen,
              onToggle: (event: Event) => {
                this.moreOpen = (event.target as HTMLDetailsElement).open;
              },
            },
            h('summary', {}, `More (${rest.length})`),
            ...rest,
          );
    const facts = sheet.facts.length > 0 ? h('p', { class: 'facts' }, sheet.facts.join(' · ')) : null;
    return h('section', { class: 'sheet', 'aria-label': sheet.title }, h('h3', {}, sheet.title), facts, ...rows, more);
  }

  private send(sheet: Sheet, field: EditableField, value: WireValue): void {
    const edit = { target: sheet.target, ...sheet.index, [field.name]: value } as unknown as Edit;
    this.edit(`${sheet.title}, ${field.name}`, edit);
  }

  private rebuildOrRefresh(): void {
    const now = this.sheets()
      .map((s) => s.title + JSON.stringify(s.index))
      .join();
    const before = this.shown.map((s) => s.sheet.title + JSON.stringify(s.sheet.index)).join();
    if (now === before) this.refresh();
    else this.rebuild();
  }

  private refresh(): void {
    const scene = this.model.scene;
    if (!scene) return;
    for (const { sheet, fields } of this.shown) {
      const item = sheet.read(scene);
      for (const [name, field] of fields) {
        const value = item?.[name];
        if (value !== undefined) field.set(value as WireValue);
      }
    }
  }
}

function sheetsOf(scene: SceneMessage, selection: Selection): Sheet[] {
  switch (selection.kind) {
    case 'nothing':
      return [];
    case 'environment':
      return [environmentSheet()];
    case 'material':
      return [materialSheet(scene, selection.material)];
    case 'light':
      return [lightSheet(scene, selection.light), ...carriersOf(scene, selection.light)];
    case 'node': {
      const light = scene.nodes[selection.node]?.light;
      return [
        ...(selection.material === undefined ? [] : [materialSheet(scene, selection.material)]),
        ...(light === undefined ? [] : [lightSheet(scene, light)]),
        nodeSheet(scene, selection.node),
      ];
    }
  }
}

function materialSheet(scene: SceneMessage, material: number): Sheet {
  const item = scene.materials[material];
  const facts: string[] = [];
  if (item && item.textures.length > 0) facts.push(`images multiply ${item.textures.join(', ')}`);
  if (item?.doubleSided) facts.push('double-sided');
  if (item?.unlit) facts.push('unlit');
  return {
    title: nameOf(item?.name, 'Material', material),
    target: 'material',
    index: { material },
    facts,
    read: (s) => s.materials[material] as Item | undefined,
  };
}

function lightSheet(scene: SceneMessage, light: number): Sheet {
  const item = scene.lights[light];
  return {
    title: nameOf(item?.name, 'Light', light),
    target: 'light',
    index: { light },
    facts: item ? [`${item.type} light`] : [],
    read: (s) => s.lights[light] as Item | undefined,
  };
}

/** The nodes that carry a light: moving them moves the light. */
function carriersOf(scene: SceneMessage, light: number): Sheet[] {
  return scene.nodes.flatMap((node, i) => (node.light === light ? [nodeSheet(scene, i)] : []));
}

function nodeSheet(scene: SceneMessage, node: number): Sheet {
  const item = scene.nodes[node];
  const facts: string[] = [];
  const mesh = item?.mesh;
  if (mesh !== undefined) facts.push(`mesh ${nameOf(scene.meshes[mesh], '', mesh)}`);
  if (item?.parent !== undefined) facts.push(`in ${nameOf(scene.nodes[item.parent]?.name, 'Node', item.parent)}`);
  if (item?.matrix) facts.push('placed by a matrix, which a rotation or scale given here replaces');
  return {
    title: nameOf(item?.name, 'Node', node),
    target: 'node',
    index: { node },
    facts,
    read: (s) => s.nodes[node] as Item | undefined,
  };
}

function environmentSheet(): Sheet {
  return {
    title: 'Environment',
    target: 'environment',
    index: {},
    facts: ['radiance, times the image where there is one'],
    read: (s) => s.environment as unknown as Item,
  };
}

/** Leaves out fields that the thing does not hold, and those that shape the cone of a light without one. */
function isOfUse(field: EditableField, sheet: Sheet, item: Item | undefined): boolean {
  if (!item || item[field.name] === undefined) return false;
  if (sheet.target !== 'light') return true;
  if (/cone/i.test(field.name)) return item['type'] === 'spot';
  return !(field.name === 'range' && item['type'] === 'directional');
}
