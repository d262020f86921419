import { describe, expect, it } from 'vitest';
import { treeOf } from '../src/panels/scene_panel';
import type { SceneMessage } from '../src/protocol/messages.gen';
import { withEdit } from '../src/state/model';
import { sameItems, type TreeItem } from '../src/ui/tree';

const scene = {
  nodes: [{ name: 'Room' }, { name: 'Table', parent: 0, mesh: 0 }, { name: 'Lamp', light: 0 }, { name: 'Cup', parent: 1 }],
  lights: [{ name: 'Bulb', type: 'point', intensity: 1 }],
  materials: [{ name: 'Wood', roughness: 1, emission: [0, 0, 0] }],
  cameras: [],
  environment: { image: '' },
} as unknown as SceneMessage;

const outline = (item: TreeItem): string =>
  item.label + (item.children.length > 0 ? `(${item.children.map(outline).join(' ')})` : '');

describe('the tree of a scene', () => {
  it('nests nodes in their parents, in the order of the file', () => {
    const objects = treeOf(scene).find((item) => item.key === 'group:nodes');
    expect(objects && outline(objects)).toBe('Objects(Room(Table(Cup)) Lamp)');
  });

  it('looks the same after an edit that it does not show, and another after one that it does', () => {
    const after = (emission: [number, number, number]) =>
      treeOf(withEdit(scene, { target: 'material', material: 0, roughness: 0.5, emission }));
    expect(sameItems(treeOf(scene), after([0, 0, 0]))).toBe(true);
    expect(sameItems(treeOf(scene), after([1, 0, 0]))).toBe(false);
    const grown = withEdit(scene, { target: 'node', node: 0, translation: [0, 1, 0] });
    expect(sameItems(treeOf(scene), treeOf({ ...grown, nodes: grown.nodes.slice(0, 3) }))).toBe(false);
  });
});
