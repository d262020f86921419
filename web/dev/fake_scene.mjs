// A stand-in for the renderer: three balls on a floor, cast by hand, with noise that falls as the steps rise.

const material = (name, baseColor, more = {}) => ({
  name,
  baseColor,
  metallic: 0,
  roughness: 0.5,
  emission: [0, 0, 0],
  ior: 1.5,
  transmission: 0,
  thickness: 0,
  attenuationDistance: 0,
  attenuationColor: [1, 1, 1],
  specular: 1,
  specularColor: [1, 1, 1],
  clearcoat: 0,
  clearcoatRoughness: 0,
  normalScale: 1,
  alphaCutoff: 0.5,
  alphaMode: 'opaque',
  doubleSided: false,
  unlit: false,
  textures: [],
  ...more,
});
const node = (name, more = {}) => ({ name, translation: [0, 0, 0], rotation: [0, 0, 0, 1], scale: [1, 1, 1], ...more });

export function makeScene(width = 320, height = 240) {
  return {
    name: 'fake.glb',
    hash: '0123456789abcdef',
    sceneRevision: 1,
    viewRevision: 1,
    materials: [
      material('Floor', [0.55, 0.53, 0.5, 1], { roughness: 0.9, textures: ['baseColor'] }),
      material('Terracotta', [0.65, 0.22, 0.12, 1]),
      material('Brass', [0.75, 0.55, 0.2, 1], { metallic: 1, roughness: 0.3 }),
      material('Jade', [0.12, 0.45, 0.3, 1]),
      material('Panel', [0, 0, 0, 1], { emission: [12, 11, 9] }),
    ],
    lights: [
      {
        name: 'Lamp',
        type: 'point',
        color: [1, 0.9, 0.75],
        intensity: 24,
        range: 0,
        innerConeAngle: 0,
        outerConeAngle: 0.7853981,
      },
      {
        name: 'Spot',
        type: 'spot',
        color: [0.7, 0.8, 1],
        intensity: 12,
        range: 0,
        innerConeAngle: 0.2,
        outerConeAngle: 0.5,
      },
    ],
    nodes: [
      node('Room', { mesh: 0 }),
      node('Ball, left', { parent: 0, mesh: 1, translation: [-1.3, 0.6, 0] }),
      node('Ball, middle', { parent: 0, mesh: 1, translation: [0, 0.6, -0.4] }),
      node('Ball, right', { parent: 0, mesh: 1, translation: [1.3, 0.6, 0.2] }),
      node('Lamp', { light: 0, translation: [1.5, 3, 2] }),
      node('Spot', { light: 1, translation: [-2, 3, 1] }),
      node('Eye', { camera: 0, translation: [0, 1.4, 5] }),
    ],
    meshes: ['floor', 'ball'],
    cameras: [{ name: 'Front', perspective: true, yfov: 0.7, ymag: 1, znear: 0.01 }],
    environment: { radiance: [0.25, 0.3, 0.4], rotation: 0, hasImage: false, image: '' },
    view: {
      eye: [0, 1.6, 5.2],
      target: [0, 0.6, 0],
      up: [0, 1, 0],
      perspective: true,
      yfov: 0.7,
      ymag: 1,
      znear: 0.01,
    },
    resolve: { exposure: 0, toneMap: 'pbr-neutral', view: 'beauty' },
    technique: 'path-tracing',
    parameters: { maxBounces: 8, clampIndirect: 0, maxSamples: 64, russianRoulette: 1 },
    width,
    height,
    boundsLow: [-3, 0, -3],
    boundsHigh: [3, 3, 3],
    report: {
      unsupported: [{ feature: 'KHR_materials_sheen', materials: ['Floor'], note: 'rendered without sheen' }],
      notes: ['the file has no camera in use; the view frames the scene'],
      triangles: 10_240,
      degenerateTriangles: 0,
      vertices: 5200,
      imageBytes: 0,
    },
  };
}

const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const mul = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => mul(a, 1 / Math.hypot(...a));

const kBallNodes = [1, 2, 3];

/** What the ray meets first, or null. */
export function cast(scene, eye, dir) {
  let hit = null;
  const floor = -eye[1] / dir[1];
  const at = (t) => add(eye, mul(dir, t));
  if (floor > 0 && Math.max(...at(floor).map(Math.abs)) < 3)
    hit = { t: floor, node: 0, material: 0, normal: [0, 1, 0] };
  for (const index of kBallNodes) {
    const { translation, scale } = scene.nodes[index];
    const toEye = sub(eye, translation);
    const b = dot(toEye, dir);
    const root = b * b - dot(toEye, toEye) + 0.36 * scale[0] * scale[0];
    if (root < 0) continue;
    const t = -b - Math.sqrt(root);
    if (t > 0 && (!hit || t < hit.t)) hit = { t, node: index, material: index, normal: unit(sub(at(t), translation)) };
  }
  return hit && { ...hit, position: at(hit.t) };
}

export function rayThrough(scene, x, y) {
  const { view, width, height } = scene;
  const forward = unit(sub(view.target, view.eye));
  const right = unit(cross(forward, view.up));
  const up = cross(right, forward);
  const tall = Math.tan(view.yfov / 2);
  const u = ((2 * (x + 0.5)) / width - 1) * tall * (width / height);
  const v = (1 - (2 * (y + 0.5)) / height) * tall;
  return unit(add(forward, add(mul(right, u), mul(up, v))));
}

const encode = (c) =>
  Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * Math.pow(Math.min(c, 1), 1 / 2.4) - 0.055));

/** RGBA bytes of the picture after `steps` passes. */
export function paint(scene, steps) {
  const { width, height } = scene;
  const pixels = Buffer.alloc(width * height * 4);
  const gain = Math.pow(2, scene.resolve.exposure);
  let seed = 1 + steps * 7919;
  for (let i = 0; i < width * height; i++) {
    const hit = cast(scene, scene.view.eye, rayThrough(scene, i % width, Math.floor(i / width)));
    seed = (seed * 1664525 + 1013904223) >>> 0;
    const noise = 1 + ((seed / 2 ** 32 - 0.5) * 1.6) / Math.sqrt(steps);
    const color = hit ? shade(scene, hit) : scene.environment.radiance;
    for (let c = 0; c < 3; c++) pixels[i * 4 + c] = encode(Math.max(0, color[c] * gain * noise));
    pixels[i * 4 + 3] = 255;
  }
  return pixels;
}

function shade(scene, hit) {
  const { baseColor, emission } = scene.materials[hit.material];
  const out = [...emission];
  scene.lights.forEach((light, i) => {
    const toLight = sub(scene.nodes[4 + i].translation, hit.position);
    const share = (Math.max(0, dot(unit(toLight), hit.normal)) * light.intensity) / dot(toLight, toLight) / Math.PI;
    for (let c = 0; c < 3; c++) out[c] += baseColor[c] * light.color[c] * share;
  });
  for (let c = 0; c < 3; c++) out[c] += baseColor[c] * scene.environment.radiance[c] * (0.5 + 0.5 * hit.normal[1]);
  return out;
}
