import { describe, expect, it } from 'vitest';
import { ObjectMover, movedTranslation } from '../src/camera/object_mover';
import type { Pose } from '../src/camera/orbit';
import { CameraRig } from '../src/camera/rig';
import { worldPlacement } from '../src/math/placement';
import { sub, type Vec3 } from '../src/math/vec3';
import type { Edit, SceneMessage } from '../src/protocol/messages.gen';
import { Model, withEdit } from '../src/state/model';

const upright = [0, 0, 0, 1];
const quarterTurn = [0, 0, Math.SQRT1_2, Math.SQRT1_2];
const kShear = [1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0];
const node = (fields: object) => ({ name: '', translation: [0, 0, 0], rotation: upright, scale: [1, 1, 1], ...fields });

const makeScene = () =>
  ({
    name: 'test.glb',
    nodes: [
      node({ name: 'Turned', translation: [1, 2, 3], rotation: quarterTurn, scale: [2, 3, 4] }),
      node({ name: 'Inside', parent: 0, translation: [0.5, 0, 0] }),
      node({ name: 'Matrix', parent: 0, matrix: [...kShear, 4, 5, 6, 1] }),
      node({ name: 'Flat', scale: [1, 0, 1] }),
      node({ name: 'In the flat one', parent: 3 }),
    ],
    materials: [],
  }) as unknown as SceneMessage;

const pose: Pose = {
  eye: [0, 0, 5],
  target: [0, 0, 0],
  up: [0, 1, 0],
  lens: { perspective: false, yfov: 1, ymag: 1.5, znear: 0.01 },
};

describe('movedTranslation', () => {
  it.each([0, 1, 2])('moves node %i by the step in the world, whatever its parent does', (index) => {
    const scene = makeScene();
    const step: Vec3 = [0.3, -0.2, 0.7];
    const translation = movedTranslation(scene, index, step);
    const moved = withEdit(scene, { target: 'node', node: index, translation: [...(translation ?? [])] } as Edit);
    const went = sub(worldPlacement(moved, index).origin, worldPlacement(scene, index).origin);
    went.forEach((c, i) => expect(c).toBeCloseTo(step[i] ?? NaN, 12));
  });
  it('knows no way within a flat space', () => expect(movedTranslation(makeScene(), 4, [0, 1, 0])).toBeNull());
});

function makeMover() {
  const model = new Model();
  const rig = new CameraRig({ send: () => {}, requestFrame: () => {}, reducedMotion: () => true });
  const edits: Edit[] = [];
  const refusals: string[] = [];
  model.setScene(makeScene());
  rig.adopt(pose);
  const edit = (_: string, change: Edit) => {
    model.applyLocally(change);
    edits.push(change);
  };
  return { model, rig, edits, refusals, mover: new ObjectMover(model, rig, edit, (why) => refusals.push(why)) };
}

describe('ObjectMover', () => {
  it('moves what is selected with the pointer, and the point that the camera turns about', () => {
    const { model, rig, edits, mover } = makeMover();
    model.select({ kind: 'node', node: 0 });
    rig.setPivot({ point: [0.2, 0, 1], node: 0 });
    mover.move(0.5, 0.25);
    mover.move(0.5, 0);
    expect(edits.at(-1)).toEqual({ target: 'node', node: 0, translation: [4, 2.75, 3] });
    expect(rig.pivot()).toEqual([3.2, 0.75, 1]);
  });

  it('moves what was chosen in the list with its origin, and leaves what the camera turns about', () => {
    const { model, rig, edits, mover } = makeMover();
    // From 5 m the picture is 5 m high at the target, 2 m at the node's origin and 1 m at the picked point.
    rig.adopt({ ...pose, eye: [0, 0, 5], lens: { ...pose.lens, perspective: true, yfov: 2 * Math.atan(0.5) } });
    model.select({ kind: 'node', node: 0 });
    rig.setPivot({ point: [0, 0, 4], node: 2 });
    mover.move(0, 0.5);
    const [edit] = edits as (Edit & { target: 'node' })[];
    expect(edit?.translation?.[1]).toBeCloseTo(2 + 0.5 * 2, 12);
    expect(rig.pivot()).toEqual([0, 0, 4]);
  });

  it('moves what a matrix places, and leaves the axes of the matrix', () => {
    const { model, edits, mover } = makeMover();
    model.select({ kind: 'node', node: 2 });
    mover.move(0, 0.5);
    // A quarter turn and a scale by 2 of the parent take its x to twice the world's y.
    expect(edits).toEqual([{ target: 'node', node: 2, translation: [expect.closeTo(4.75), expect.closeTo(5), 6] }]);
    expect(model.scene?.nodes[2]?.matrix?.slice(0, 12)).toEqual(kShear);
  });

  it('says why nothing moved', () => {
    const { model, edits, refusals, mover } = makeMover();
    mover.move(0.1, 0);
    model.select({ kind: 'node', node: 4 });
    mover.move(0.1, 0);
    expect(edits).toEqual([]);
    expect(refusals).toEqual([
      'Nothing moved: pick an object first',
      'Nothing moved: In the flat one is in a flat space',
    ]);
  });
});
