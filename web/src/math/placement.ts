import type { SceneMessage, SceneNode } from '../protocol/messages.gen';
import { cross, dot, type Vec3 } from './vec3';

/** Affine map of a node, column-major 3x3 and the origin: world (or parent) from local. */
export interface Placement {
  x: Vec3;
  y: Vec3;
  z: Vec3;
  origin: Vec3;
}

const kIdentity: Placement = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1], origin: [0, 0, 0] };

export const applyLinear = (p: Placement, v: Vec3): Vec3 => [
  p.x[0] * v[0] + p.y[0] * v[1] + p.z[0] * v[2],
  p.x[1] * v[0] + p.y[1] * v[1] + p.z[1] * v[2],
  p.x[2] * v[0] + p.y[2] * v[1] + p.z[2] * v[2],
];

/** The v of applyLinear(p, v) = w; null where the map is flat. */
export function solveLinear(p: Placement, w: Vec3): Vec3 | null {
  const determinant = dot(p.x, cross(p.y, p.z));
  if (determinant === 0) return null;
  return [
    dot(w, cross(p.y, p.z)) / determinant,
    dot(p.x, cross(w, p.z)) / determinant,
    dot(p.x, cross(p.y, w)) / determinant,
  ];
}

function compose(outer: Placement, inner: Placement): Placement {
  const o = applyLinear(outer, inner.origin);
  return {
    x: applyLinear(outer, inner.x),
    y: applyLinear(outer, inner.y),
    z: applyLinear(outer, inner.z),
    origin: [o[0] + outer.origin[0], o[1] + outer.origin[1], o[2] + outer.origin[2]],
  };
}

/** Parent from local of one node: its matrix, or translation x rotation x scale. */
export function localPlacement(node: SceneNode): Placement {
  if (node.matrix) {
    const m = node.matrix;
    return { x: [m[0], m[1], m[2]], y: [m[4], m[5], m[6]], z: [m[8], m[9], m[10]], origin: [m[12], m[13], m[14]] };
  }
  const [x, y, z, w] = node.rotation;
  const [sx, sy, sz] = node.scale;
  return {
    x: [(1 - 2 * (y * y + z * z)) * sx, 2 * (x * y + z * w) * sx, 2 * (x * z - y * w) * sx],
    y: [2 * (x * y - z * w) * sy, (1 - 2 * (x * x + z * z)) * sy, 2 * (y * z + x * w) * sy],
    z: [2 * (x * z + y * w) * sz, 2 * (y * z - x * w) * sz, (1 - 2 * (x * x + y * y)) * sz],
    origin: node.translation,
  };
}

/** World from local of a node, through its parents. */
export function worldPlacement(scene: SceneMessage, node: number): Placement {
  let placement = kIdentity;
  // A parent chain cannot be longer than the list; the bound keeps a broken one from hanging the page.
  let at: number | undefined = node;
  for (let depth = 0; at !== undefined && depth < scene.nodes.length; depth++) {
    const item: SceneNode | undefined = scene.nodes[at];
    if (!item) break;
    placement = compose(localPlacement(item), placement);
    at = item.parent;
  }
  return placement;
}
