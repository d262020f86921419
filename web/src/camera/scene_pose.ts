import { applyLinear, worldPlacement } from '../math/placement';
import { add, dot, length, lerp, normalize, scale, sub } from '../math/vec3';
import type { SceneMessage, View } from '../protocol/messages.gen';
import { levelled, type Box, type Pose } from './orbit';

const kDefaultLens = { perspective: true, yfov: 0.8, ymag: 1, znear: 0.01 };

/** The viewer's camera as the server tells it, whose `up` is often at a right angle to the line of sight. */
export function poseFromView(view: View): Pose {
  const { eye, target, up, ...lens } = view;
  return levelled({ eye, target, up, lens: { ...kDefaultLens, ...lens } });
}

export function viewFromPose(pose: Pose): View {
  return { eye: [...pose.eye], target: [...pose.target], up: [...pose.up], ...pose.lens };
}

export const boundsOf = (scene: SceneMessage): Box => ({ low: scene.boundsLow, high: scene.boundsHigh });

/** The view through a camera of the file; it orbits about the scene's middle. Null when no node carries the camera. */
export function poseOfCamera(scene: SceneMessage, camera: number): Pose | null {
  const lens = scene.cameras[camera];
  const node = scene.nodes.findIndex((n) => n.camera === camera);
  if (!lens || node < 0) return null;
  const placement = worldPlacement(scene, node);
  const forward = normalize(applyLinear(placement, [0, 0, -1]));
  const toMiddle = sub(lerp(scene.boundsLow, scene.boundsHigh, 0.5), placement.origin);
  const radius = length(sub(scene.boundsHigh, scene.boundsLow)) / 2;
  const distance = Math.max(dot(toMiddle, forward), radius * 0.1);
  const { perspective, yfov, ymag, znear } = lens;
  return levelled({
    eye: placement.origin,
    target: add(placement.origin, scale(forward, distance)),
    up: normalize(applyLinear(placement, [0, 1, 0])),
    lens: { perspective, yfov, ymag, znear },
  });
}
