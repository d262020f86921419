import { describe, expect, it } from 'vitest';
import { dolly, forwardOf, frameBox, heightAt, orbit, pan, rightOf, type Pose } from '../src/camera/orbit';
import { cross, dot, length, normalize, sub, type Vec3 } from '../src/math/vec3';

const pose: Pose = {
  eye: [0, 0, 5],
  target: [0, 0, 0],
  up: [0, 1, 0],
  lens: { perspective: true, yfov: 1, ymag: 1, znear: 0.01 },
};
const distance = (a: Vec3, b: Vec3) => length(sub(a, b));

/** Where a point falls in the picture: shares of its height from the middle, to the right and up. */
function project(p: Pose, point: Vec3): [number, number] {
  const toPoint = sub(point, p.eye);
  const forward = forwardOf(p);
  const right = rightOf(p);
  const up = cross(right, forward);
  const height = 2 * dot(toPoint, forward) * Math.tan(p.lens.yfov / 2);
  return [dot(toPoint, right) / height, dot(toPoint, up) / height];
}

describe('orbit', () => {
  it('keeps the distance to the pivot and the place of the pivot in the picture', () => {
    const pivot: Vec3 = [0.7, -0.4, 1.1];
    const turned = orbit(pose, pivot, 0.9, -0.4);
    expect(distance(turned.eye, pivot)).toBeCloseTo(distance(pose.eye, pivot), 12);
    const [x, y] = project(turned, pivot);
    const [x0, y0] = project(pose, pivot);
    expect(x).toBeCloseTo(x0, 10);
    expect(y).toBeCloseTo(y0, 10);
  });

  it('goes right and up for positive yaw and negative pitch', () => {
    expect(orbit(pose, pose.target, 0.3, 0).eye[0]).toBeGreaterThan(1);
    expect(orbit(pose, pose.target, 0, -0.3).eye[1]).toBeGreaterThan(1);
  });

  it('stops before the poles, and the picture stays upright there', () => {
    const above = orbit(pose, pose.target, 0, -10);
    expect(dot(forwardOf(above), [0, -1, 0])).toBeGreaterThan(0.99);
    expect(dot(rightOf(above), rightOf(pose))).toBeCloseTo(1, 6);
    const again = orbit(above, pose.target, 0, -10);
    expect(distance(again.eye, above.eye)).toBeLessThan(1e-9);
  });

  it('is undone by the opposite turn', () => {
    const back = orbit(orbit(pose, pose.target, 0.4, 0.2), pose.target, 0, -0.2);
    expect(distance(orbit(back, pose.target, -0.4, 0).eye, pose.eye)).toBeLessThan(1e-12);
  });
});

describe('pan', () => {
  it('moves the pivot by the given shares of the picture', () => {
    const pivot: Vec3 = [0.3, 0.2, 1];
    const [x0, y0] = project(pose, pivot);
    const [x, y] = project(pan(pose, pivot, 0.25, -0.1), pivot);
    expect(x - x0).toBeCloseTo(0.25, 10);
    expect(y - y0).toBeCloseTo(-0.1, 10);
  });

  it('follows the orthographic height', () => {
    const flat: Pose = { ...pose, lens: { ...pose.lens, perspective: false, ymag: 3 } };
    expect(heightAt(flat, flat.target)).toBe(6);
    expect(pan(flat, flat.target, 0.5, 0).eye[0]).toBeCloseTo(-3, 12);
  });
});

describe('dolly', () => {
  it('scales the distance to the pivot and keeps the direction', () => {
    const pivot: Vec3 = [1, 0.5, 0];
    const near = dolly(pose, pivot, 0.5, 10);
    expect(distance(near.eye, pivot)).toBeCloseTo(distance(pose.eye, pivot) / 2, 12);
    expect(dot(forwardOf(near), forwardOf(pose))).toBeCloseTo(1, 12);
    expect(project(near, pivot)[0]).toBeCloseTo(project(pose, pivot)[0], 10);
  });

  it('stays within limits of the scene, so that no number becomes zero or infinite', () => {
    let p = pose;
    for (let i = 0; i < 200; i++) p = dolly(p, p.target, 0.5, 10);
    expect(distance(p.eye, p.target)).toBeCloseTo(1e-3, 9);
    for (let i = 0; i < 200; i++) p = dolly(p, p.target, 2, 10);
    expect(distance(p.eye, p.target)).toBeCloseTo(1000, 6);
  });

  it.each([true, false])('never goes the other way where it is beyond its limits; perspective: %s', (perspective) => {
    const sizeOf = (p: Pose) => (perspective ? distance(p.eye, p.target) : p.lens.ymag);
    const lens = (size: number) => ({ ...pose.lens, perspective, ymag: size });
    const at = (size: number): Pose => ({ ...pose, eye: [0, 0, size], lens: lens(size) });
    const zoomed = (size: number, factor: number) => sizeOf(dolly(at(size), pose.target, factor, 1));
    expect([zoomed(1e-5, 0.9), zoomed(1e3, 1.1)]).toEqual([1e-5, 1e3]);
    expect(zoomed(1e-5, 2)).toBeCloseTo(2e-5, 12);
    expect(zoomed(1e3, 0.5)).toBeCloseTo(500, 9);
  });
});

describe('frameBox', () => {
  it.each([0.5, 1, 2])('holds all corners of the box at aspect %d', (aspect) => {
    const box = { low: [-2, 0, -1] as Vec3, high: [3, 4, 2] as Vec3 };
    const framed = frameBox(orbit(pose, pose.target, 0.7, -0.3), box, aspect);
    for (let corner = 0; corner < 8; corner++) {
      const point = [0, 1, 2].map((k) => (corner & (1 << k) ? box.high[k] : box.low[k])) as unknown as Vec3;
      const [x, y] = project(framed, point);
      expect(Math.abs(x)).toBeLessThanOrEqual(aspect / 2);
      expect(Math.abs(y)).toBeLessThanOrEqual(0.5);
    }
    expect(dot(forwardOf(framed), normalize(sub(framed.target, framed.eye)))).toBeCloseTo(1, 12);
  });
});
