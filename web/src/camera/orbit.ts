import {
  add,
  anyPerpendicular,
  cross,
  dot,
  length,
  lerp,
  normalize,
  rotateAbout,
  scale,
  sub,
  type Vec3,
} from '../math/vec3';

/** Lens of the viewer; the fields of a glTF camera. */
export interface Lens {
  perspective: boolean;
  yfov: number; // [rad]
  ymag: number; // orthographic half height [m]
  znear: number; // [m]
}

/** Where the picture is taken from: world space, metres. */
export interface Pose {
  eye: Vec3;
  target: Vec3;
  up: Vec3;
  lens: Lens;
}

export interface Box {
  low: Vec3;
  high: Vec3;
}

// Nearest angle between the line of sight and `up` [rad]: below it "right" is no longer defined.
const kPoleMargin = 0.02;
const kWorldUp: Vec3 = [0, 1, 0];
// Two unit vectors to the right that differ by less make the same picture.
const kLevelSlack = 1e-4;
const kNearestShare = 1e-4;
const kFarthestShare = 100;

export const forwardOf = (pose: Pose): Vec3 => normalize(sub(pose.target, pose.eye));

/** Unit vector to the right of the picture. */
export function rightOf(pose: Pose): Vec3 {
  const right = normalize(cross(forwardOf(pose), pose.up));
  return length(right) > 0 ? right : anyPerpendicular(normalize(pose.up));
}

/**
 * The pose with the world's up, about which an orbit leaves the horizon level, where that makes the same picture. A
 * rolled camera and one that looks straight up or down keep their own.
 */
export function levelled(pose: Pose): Pose {
  const across = cross(forwardOf(pose), kWorldUp);
  if (length(across) <= Math.sin(kPoleMargin)) return pose;
  const isLevel = length(sub(rightOf(pose), normalize(across))) < kLevelSlack;
  return isLevel ? { ...pose, up: kWorldUp } : pose;
}

/** Turns eye and target about `pivot`: `yaw` about up, `pitch` about the picture's right axis, up to the poles [rad]. */
export function orbit(pose: Pose, pivot: Vec3, yaw: number, pitch: number): Pose {
  const up = normalize(pose.up);
  const polar = Math.acos(Math.min(1, Math.max(-1, dot(forwardOf(pose), up))));
  const wanted = Math.min(Math.PI - kPoleMargin, Math.max(kPoleMargin, polar - pitch));
  const right = rightOf(pose);
  const turn = (p: Vec3): Vec3 => {
    const pitched = rotateAbout(sub(p, pivot), right, polar - wanted);
    return add(pivot, rotateAbout(pitched, up, yaw));
  };
  return { ...pose, eye: turn(pose.eye), target: turn(pose.target) };
}

/** Height of the picture in the plane through `pivot` [m]. */
export function heightAt(pose: Pose, pivot: Vec3): number {
  if (!pose.lens.perspective) return 2 * pose.lens.ymag;
  const depth = dot(sub(pivot, pose.eye), forwardOf(pose));
  const distance = depth > 0 ? depth : length(sub(pose.target, pose.eye));
  return 2 * distance * Math.tan(pose.lens.yfov / 2);
}

/** World vector [m] that at `pivot`'s depth covers (right, up) in shares of the picture's height. */
export function stepInPicture(pose: Pose, pivot: Vec3, right: number, up: number): Vec3 {
  const height = heightAt(pose, pivot);
  const rightDir = rightOf(pose);
  const upDir = cross(rightDir, forwardOf(pose));
  return add(scale(rightDir, right * height), scale(upDir, up * height));
}

/** Moves the camera so that the picture at `pivot`'s depth follows by (right, up) in shares of the picture's height. */
export function pan(pose: Pose, pivot: Vec3, right: number, up: number): Pose {
  const move = stepInPicture(pose, pivot, -right, -up);
  return { ...pose, eye: add(pose.eye, move), target: add(pose.target, move) };
}

/** A length times `factor`, up to limits taken from the scene's radius [m]; one beyond them only comes back. */
function scaledWithin(value: number, factor: number, sceneRadius: number): number {
  const scaled = value * factor;
  return factor < 1
    ? Math.min(value, Math.max(sceneRadius * kNearestShare, scaled))
    : Math.max(value, Math.min(sceneRadius * kFarthestShare, scaled));
}

/** Scales the distance to `pivot`, or what an orthographic lens takes in, by `factor` (< 1: nearer), within limits. */
export function dolly(pose: Pose, pivot: Vec3, factor: number, sceneRadius: number): Pose {
  if (!pose.lens.perspective) {
    return { ...pose, lens: { ...pose.lens, ymag: scaledWithin(pose.lens.ymag, factor, sceneRadius) } };
  }
  const distance = length(sub(pose.eye, pivot));
  if (distance === 0) return pose;
  const share = scaledWithin(distance, factor, sceneRadius) / distance;
  const move = (p: Vec3): Vec3 => lerp(pivot, p, share);
  return { ...pose, eye: move(pose.eye), target: move(pose.target) };
}

/** The pose that looks in the same direction and holds all of `box`; `aspect` is width / height. */
export function frameBox(pose: Pose, box: Box, aspect: number): Pose {
  const center = lerp(box.low, box.high, 0.5);
  const radius = Math.max(length(sub(box.high, box.low)) / 2, 1e-9);
  const halfY = pose.lens.yfov / 2;
  const halfX = Math.atan(Math.tan(halfY) * aspect);
  const distance = radius / Math.sin(Math.min(halfX, halfY));
  const lens = pose.lens.perspective ? pose.lens : { ...pose.lens, ymag: radius / Math.min(1, aspect) };
  return { ...pose, target: center, eye: sub(center, scale(forwardOf(pose), distance)), lens };
}

/** The pose moved, without turning, so that `point` is looked at; the distance to it stays that of the old target. */
export function lookAtPoint(pose: Pose, point: Vec3): Pose {
  const move = sub(point, pose.target);
  return { ...pose, eye: add(pose.eye, move), target: point };
}

/** Between two poses, 0 <= t <= 1; eye and target move on straight lines. */
export function blend(from: Pose, to: Pose, t: number): Pose {
  const mix = (a: number, b: number) => a + (b - a) * t;
  return {
    eye: lerp(from.eye, to.eye, t),
    target: lerp(from.target, to.target, t),
    up: to.up,
    lens: { ...to.lens, ymag: mix(from.lens.ymag, to.lens.ymag), yfov: mix(from.lens.yfov, to.lens.yfov) },
  };
}
