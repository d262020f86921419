import { localPlacement, solveLinear, worldPlacement } from '../math/placement';
import { add, type Vec3 } from '../math/vec3';
import { nameOf } from '../panels/names';
import type { Edit, SceneMessage } from '../protocol/messages.gen';
import type { Model } from '../state/model';
import { stepInPicture } from './orbit';
import type { CameraRig } from './rig';

/** Where a node's own translation is after it moved by `step` in the world; null where its parent's space is flat. */
export function movedTranslation(scene: SceneMessage, node: number, step: Vec3): Vec3 | null {
  const item = scene.nodes[node];
  if (!item) return null;
  const inParent = item.parent === undefined ? step : solveLinear(worldPlacement(scene, item.parent), step);
  return inParent && add(localPlacement(item).origin, inParent);
}

/**
 * Moves the selected object parallel to the picture, so that what was picked of it stays under the pointer. Where
 * nothing was, its origin goes with the pointer, and what the camera turns about stays.
 */
export class ObjectMover {
  constructor(
    private readonly model: Model,
    private readonly rig: CameraRig,
    private readonly edit: (label: string, edit: Edit) => void,
    private readonly refuse: (why: string) => void,
  ) {}

  /** Shares of the picture's height. */
  move(right: number, up: number): void {
    const { scene, selection } = this.model;
    const pose = this.rig.current();
    if (!scene || !pose) return;
    if (selection.kind !== 'node') {
      this.refuse('Nothing moved: pick an object first');
      return;
    }
    const { node } = selection;
    const name = nameOf(scene.nodes[node]?.name, 'Node', node);
    const held = this.rig.pickedOf(node);
    const step = stepInPicture(pose, held ?? worldPlacement(scene, node).origin, right, up);
    const translation = movedTranslation(scene, node, step);
    if (!translation) {
      this.refuse(`Nothing moved: ${name} is in a flat space`);
      return;
    }
    this.edit(`${name}, translation`, { target: 'node', node, translation: [...translation] });
    if (held) this.rig.setPivot({ point: add(held, step), node });
  }
}
