import type { Edit, SceneMessage } from '../protocol/messages.gen';

type Values = { [name: string]: unknown };

// Fields of an edit that say what it is about.
const kAddress = new Set(['target', 'material', 'light', 'node']);

/** The edit that puts back what `scene` holds where `edit` changes it; null where no edit can. */
export function inverseOf(scene: SceneMessage, edit: Edit): Edit | null {
  switch (edit.target) {
    case 'material':
      return withValuesOf(scene.materials[edit.material], edit);
    case 'light':
      return withValuesOf(scene.lights[edit.light], edit);
    case 'node':
      return losesMatrix(scene, edit) ? null : withValuesOf(scene.nodes[edit.node], edit);
    case 'environment':
      return losesNamelessImage(scene, edit) ? null : withValuesOf(scene.environment, edit);
    case 'resolve':
      return withValuesOf(scene.resolve, edit);
    case 'image':
      return withValuesOf(scene, edit);
    case 'technique':
      return formerTechnique(scene, edit);
    case 'camera':
      return null;
  }
}

/** A matrix gives way to a rotation or a scale, and no edit brings it back; a translation it takes up. */
function losesMatrix(scene: SceneMessage, edit: Edit & { target: 'node' }): boolean {
  const turns = edit.rotation !== undefined || edit.scale !== undefined;
  return turns && scene.nodes[edit.node]?.matrix !== undefined;
}

/** An image that came with the scene has no path by which an edit could name it again. */
function losesNamelessImage({ environment }: SceneMessage, edit: Edit & { target: 'environment' }): boolean {
  return edit.image !== undefined && environment.hasImage && environment.image === '';
}

/** `edit` with the values of `item`; null where that lacks one. */
function withValuesOf(item: object | undefined, edit: Edit): Edit | null {
  const pairs = Object.entries(edit).map(
    ([name, value]): [string, unknown] => [name, kAddress.has(name) ? value : (item as Values | undefined)?.[name]],
  );
  return pairs.every(([, value]) => value !== undefined) ? (Object.fromEntries(pairs) as unknown as Edit) : null;
}

function formerTechnique(scene: SceneMessage, edit: Edit & { target: 'technique' }): Edit | null {
  // Another technique forgets the parameters of this one.
  if (edit.technique !== undefined)
    return { target: 'technique', technique: scene.technique, parameters: { ...scene.parameters } };
  const names = Object.keys(edit.parameters ?? {});
  const former = names.map((name): [string, number | undefined] => [name, scene.parameters[name]]);
  if (former.some(([, value]) => value === undefined)) return null;
  return { target: 'technique', parameters: Object.fromEntries(former) as { [name: string]: number } };
}
