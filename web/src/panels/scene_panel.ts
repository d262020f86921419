import type { SceneMessage } from '../protocol/messages.gen';
import type { Model, Selection } from '../state/model';
import { h, setText } from '../ui/dom';
import { formatCount } from '../ui/format';
import { Tree, type TreeItem } from '../ui/tree';
import { nameOf } from './names';

// Groups longer than this begin folded, so that the others are seen.
const kLongGroup = 12;

/** The scene as a list, the keyboard's equal of picking; what loading left out; a field to load another file. */
export class ScenePanel {
  private readonly tree: Tree;
  private readonly report = h('div', { class: 'report' });
  private reported = '';
  private readonly uri = h('input', {
    type: 'text',
    'aria-label': 'Scene file under the asset root',
    placeholder: 'scene.glb',
    spellcheck: false,
  });

  constructor(
    root: HTMLElement,
    model: Model,
    load: (uri: string) => void,
    useCamera: (index: number) => void,
  ) {
    this.tree = new Tree('Scene', (key) => {
      const [kind, index] = splitKey(key);
      if (kind === 'camera') useCamera(index);
      else model.select(selectionOf(key));
    });
    const form = h(
      'form',
      {
        class: 'load',
        onSubmit: (event: Event) => {
          event.preventDefault();
          if (this.uri.value.trim()) load(this.uri.value.trim());
        },
      },
      this.uri,
      h('button', { type: 'submit' }, 'Load'),
    );
    root.append(this.tree.element, this.report, form);
    model.on('scene', (scene) => this.show(scene));
    model.on('selection', (selection) => this.tree.select(keyOf(selection)));
  }

  private show(scene: SceneMessage): void {
    this.tree.show(treeOf(scene));
    const facts = `${formatCount(scene.report.triangles)} triangles, ${scene.materials.length} materials`;
    const lines = reportLines(scene);
    const reported = [facts, ...lines].join('\n');
    if (reported === this.reported) return; // an unfolded report stays so
    this.reported = reported;
    this.report.replaceChildren(h('p', { class: 'quiet' }, facts));
    if (lines.length === 0) return;
    this.report.append(
      h(
        'details',
        {},
        h('summary', {}, `Load report (${lines.length})`),
        h('ul', {}, ...lines.map((line) => h('li', {}, line))),
      ),
    );
  }
}

/** What loading left out, and what else it has to say. */
function reportLines({ report }: SceneMessage): string[] {
  const left = report.unsupported.map(
    (u) => `${u.feature}: ${u.note}${u.materials.length ? ` (${u.materials.join(', ')})` : ''}`,
  );
  return [...left, ...report.notes];
}

/** Puts the scene's file name into the bar. */
export function bindSceneName(element: HTMLElement, model: Model): void {
  model.on('scene', (scene) => setText(element, scene.name));
}

function splitKey(key: string): [string, number] {
  const [kind = '', index = '0'] = key.split(':');
  return [kind, Number(index)];
}

function selectionOf(key: string): Selection {
  const [kind, index] = splitKey(key);
  switch (kind) {
    case 'node':
      return { kind: 'node', node: index };
    case 'glow':
    case 'material':
      return { kind: 'material', material: index };
    case 'light':
      return { kind: 'light', light: index };
    case 'environment':
      return { kind: 'environment' };
    default:
      return { kind: 'nothing' };
  }
}

function keyOf(selection: Selection): string | null {
  switch (selection.kind) {
    case 'node':
      return `node:${selection.node}`;
    case 'material':
      return `material:${selection.material}`;
    case 'light':
      return `light:${selection.light}`;
    case 'environment':
      return 'environment:0';
    case 'nothing':
      return null;
  }
}

function childrenOf(scene: SceneMessage): Map<number | undefined, number[]> {
  const children = new Map<number | undefined, number[]>();
  scene.nodes.forEach(({ parent }, i) => {
    const siblings = children.get(parent);
    if (siblings) siblings.push(i);
    else children.set(parent, [i]);
  });
  return children;
}

export function treeOf(scene: SceneMessage): TreeItem[] {
  const children = childrenOf(scene);
  const nodeItem = (i: number): TreeItem => {
    const node = scene.nodes[i];
    const note =
      node?.mesh !== undefined
        ? 'mesh'
        : node?.light !== undefined
          ? 'light'
          : node?.camera !== undefined
            ? 'camera'
            : undefined;
    return {
      key: `node:${i}`,
      label: nameOf(node?.name, 'Node', i),
      note,
      children: (children.get(i) ?? []).map(nodeItem),
    };
  };
  const leaf = (key: string, label: string, note?: string): TreeItem => ({ key, label, note, children: [] });
  const group = (key: string, label: string, items: TreeItem[]): TreeItem[] =>
    items.length > 0 ? [{ key, label, children: items, foldedAtFirst: items.length > kLongGroup }] : [];
  const glows = (emission: readonly number[]) => emission.some((c) => c > 0);
  return [
    ...group('group:lights', 'Lights', [
      ...scene.lights.map((light, i) => leaf(`light:${i}`, nameOf(light.name, 'Light', i), light.type)),
      ...scene.materials.flatMap((m, i) =>
        glows(m.emission) ? [leaf(`glow:${i}`, nameOf(m.name, 'Material', i), 'surface')] : [],
      ),
      leaf('environment:0', 'Environment', scene.environment.image ? 'image' : 'constant'),
    ]),
    ...group(
      'group:cameras',
      'Cameras',
      scene.cameras.map((c, i) => leaf(`camera:${i}`, nameOf(c.name, 'Camera', i))),
    ),
    ...group('group:nodes', 'Objects', (children.get(undefined) ?? []).map(nodeItem)),
    ...group(
      'group:materials',
      'Materials',
      scene.materials.map((m, i) =>
        leaf(`material:${i}`, nameOf(m.name, 'Material', i), glows(m.emission) ? 'glows' : undefined),
      ),
    ),
  ];
}
