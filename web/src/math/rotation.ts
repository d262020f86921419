import type { Vec3 } from './vec3';

/** Unit quaternion as glTF writes it: x, y, z, w. */
export type Quat = readonly [number, number, number, number];

const kDegree = Math.PI / 180;
// Beyond this sine of the middle angle the first and last axes coincide (gimbal lock), and the last is put to zero.
const kGimbalSine = 0.9999999;
// Components of one rotation differ by less: it was rounded to single precision, or its angles to what is shown.
const kRounding = 1e-6;

/** Quaternion of the rotation about x, then y, then z, of the fixed axes; angles in degrees. */
export function quatFromEuler(degrees: Vec3): Quat {
  const [x, y, z] = degrees.map((d) => (d * kDegree) / 2) as [number, number, number];
  const [cx, sx, cy, sy, cz, sz] = [Math.cos(x), Math.sin(x), Math.cos(y), Math.sin(y), Math.cos(z), Math.sin(z)];
  return [
    sx * cy * cz - cx * sy * sz,
    cx * sy * cz + sx * cy * sz,
    cx * cy * sz - sx * sy * cz,
    cx * cy * cz + sx * sy * sz,
  ];
}

/** The inverse of quatFromEuler; the middle angle is in -90..90 degrees. */
export function eulerFromQuat(q: Quat): Vec3 {
  const norm = Math.hypot(...q) || 1;
  const [x, y, z, w] = q.map((c) => c / norm) as [number, number, number, number];
  const sine = 2 * (w * y - z * x);
  if (Math.abs(sine) > kGimbalSine) {
    const half = 2 * Math.atan2(x, w);
    return [half / kDegree, Math.sign(sine) * 90, 0];
  }
  return [
    Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)) / kDegree,
    Math.asin(sine) / kDegree,
    Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) / kDegree,
  ];
}

/** True when both turn the same way; a quaternion and its negative do. */
function isSameRotation(a: Quat, b: Quat): boolean {
  const sign = a.reduce((sum, c, i) => sum + c * (b[i] ?? 0), 0) < 0 ? -1 : 1;
  return a.every((c, i) => Math.abs(c - sign * (b[i] ?? 0)) < kRounding);
}

/** Angles of `q` as they are shown: `shown` where those say the same, for many angles make one rotation. */
export function anglesOf(q: Quat, shown: Vec3): Vec3 {
  if (isSameRotation(q, quatFromEuler(shown))) return shown;
  const [x, y, z] = eulerFromQuat(q);
  const rounded = (angle: number) => Number(angle.toFixed(4));
  return [rounded(x), rounded(y), rounded(z)];
}
