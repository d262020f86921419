import { describe, expect, it } from 'vitest';
import { forwardOf, orbit, rightOf, type Pose } from '../src/camera/orbit';
import { poseFromView, poseOfCamera } from '../src/camera/scene_pose';
import { quatFromEuler } from '../src/math/rotation';
import { cross, length, normalize, rotateAbout, sub, type Vec3 } from '../src/math/vec3';
import type { SceneMessage, View } from '../src/protocol/messages.gen';

const kWorldUp: Vec3 = [0, 1, 0];
const eye: Vec3 = [0.7, 1.6, 2];
const target: Vec3 = [0, 1, 0];

/** A view with the up that limnd tells: at a right angle to the line of sight, and turned about it by `roll` [rad]. */
function toldView(eye: Vec3, roll: number): View {
  const forward = normalize(sub(target, eye));
  const right = normalize(cross(forward, kWorldUp));
  return { eye: [...eye], target: [...target], up: [...rotateAbout(cross(right, forward), forward, roll)] };
}

/** The pose through the one camera of a scene, whose node is turned by these angles [degree]. */
function poseThrough(angles: Vec3): Pose | null {
  const node = { camera: 0, translation: eye, rotation: [...quatFromEuler(angles)].map(Math.fround), scale: [1, 1, 1] };
  const lens = { perspective: true, yfov: 1, ymag: 1, znear: 0.01 };
  const bounds = { boundsLow: [-1, -1, -1], boundsHigh: [1, 1, 1] };
  return poseOfCamera({ cameras: [lens], nodes: [node], ...bounds } as unknown as SceneMessage, 0);
}

const expectClose = (a: Vec3, b: Vec3, most: number) => expect(length(sub(a, b))).toBeLessThan(most);

describe('poseFromView', () => {
  it('leaves the eye at its height and the horizon level over half a turn', () => {
    const turned = orbit(poseFromView(toldView(eye, 0)), target, Math.PI, 0);
    expectClose(turned.eye, [-0.7, 1.6, -2], 1e-12);
    expect(rightOf(turned)[1]).toBeCloseTo(0, 12);
  });

  it('makes the picture that the server told of', () => {
    const view = toldView(eye, 0);
    const pose = poseFromView(view);
    expect(pose.up).toEqual(kWorldUp);
    expectClose(cross(rightOf(pose), forwardOf(pose)), view.up as Vec3, 1e-12);
  });

  it.each([0.01, -1, Math.PI])('leaves a camera alone that is rolled by %d rad', (roll) => {
    const view = toldView(eye, roll);
    expect(poseFromView(view).up).toEqual(view.up);
  });

  it('leaves a camera alone that looks straight down', () => {
    const view: View = { eye: [0, 5, 0.01], target: [0, 1, 0], up: [0, 0, -1] };
    expect(poseFromView(view).up).toEqual([0, 0, -1]);
  });
});

describe('poseOfCamera', () => {
  it('is level where its node is, whatever single precision made of the rotation', () => {
    expect(poseThrough([-20, 0, 0])?.up).toEqual(kWorldUp);
    expect(poseThrough([-20, 40, 0])?.up).toEqual(kWorldUp);
  });

  it('keeps the roll of its node', () => {
    expectClose(poseThrough([0, 0, 20])!.up, rotateAbout(kWorldUp, [0, 0, 1], Math.PI / 9), 1e-6);
  });
});
