import { describe, expect, it, vi } from 'vitest';
import type { FrameReport } from '../src/channel';
import { shareOfStage } from '../src/panels/picture_size';
import { fitPicture, pixelAt } from '../src/panels/stage';
import type { FrameHeader, SceneMessage, Status, View } from '../src/protocol/messages.gen';
import { Model, withEdit } from '../src/state/model';
import { Statistics, thin } from '../src/state/statistics';
import { Announcer } from '../src/ui/announcer';
import { sliderScale } from '../src/ui/fields';
import { formatBytes, formatNumber, formatSeconds, titleFromName } from '../src/ui/format';
import { decades } from '../src/ui/plot';

const scene = {
  op: 'scene',
  cause: 'joined',
  name: 'a.glb',
  materials: [
    { name: 'red', roughness: 1 },
    { name: 'blue', roughness: 1 },
  ],
  lights: [{ name: 'lamp', intensity: 1 }],
  nodes: [{ name: 'n', translation: [0, 0, 0] }],
  environment: { rotation: 0 },
  resolve: { exposure: 0, toneMap: 'aces', view: 'beauty' },
  technique: 'path-tracing',
  parameters: { maxBounces: 8 },
  view: { yfov: 1 },
  width: 4,
  height: 4,
} as unknown as SceneMessage;

describe('Model', () => {
  it('applies an edit to the one thing it is about', () => {
    const edited = withEdit(scene, { target: 'material', material: 1, roughness: 0.25 });
    expect(edited.materials.map((m) => m.roughness)).toEqual([1, 0.25]);
    expect(scene.materials[1]?.roughness).toBe(1);
    expect(withEdit(scene, { target: 'technique', parameters: { maxBounces: 3 } }).parameters).toEqual({
      maxBounces: 3,
    });
    expect(withEdit(scene, { target: 'resolve', exposure: 2 }).resolve).toEqual({ exposure: 2, toneMap: 'aces', view: 'beauty' });
  });

  it('keeps the lens that a camera edit brings, and what it leaves out', () => {
    const model = new Model();
    model.setScene(scene);
    const look: View = { eye: [0, 0, 3], target: [0, 0, 0], up: [0, 1, 0] };
    model.applyLocally({ target: 'camera', view: { ...look, yfov: 0.5 } });
    expect(model.scene?.view).toEqual({ ...look, yfov: 0.5 });
    model.applyLocally({ target: 'camera', view: { ...look, eye: [0, 1, 3] } });
    model.applyLocally({ target: 'resolve', exposure: 1 });
    expect(model.scene?.view).toEqual({ ...look, eye: [0, 1, 3], yfov: 0.5 });
  });

  it('does not carry parameters over to another technique', () => {
    const chosen = withEdit(scene, { target: 'technique', technique: 'point-projection' });
    expect([chosen.technique, chosen.parameters]).toEqual(['point-projection', {}]);
    expect(withEdit(scene, { target: 'technique', technique: 'path-tracing' }).parameters).toEqual({ maxBounces: 8 });
  });

  it('places a node that has a matrix as the server does', () => {
    const trs = { name: 'm', translation: [7, 8, 9], rotation: [0, 0, 0, 1], scale: [1, 1, 1] };
    const axes = [1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0];
    const sheared = { ...scene, nodes: [{ ...trs, matrix: [...axes, 7, 8, 9, 1] }] } as unknown as SceneMessage;
    const placed = (fields: object) => withEdit(sheared, { target: 'node', node: 0, ...fields }).nodes[0];
    const to = { translation: [1, 2, 3] };
    expect(placed(to)).toEqual({ ...trs, ...to, matrix: [...axes, 1, 2, 3, 1] });
    expect(placed({ ...to, scale: [2, 2, 2] })).toEqual({ ...trs, ...to, scale: [2, 2, 2] });
    expect(placed({ rotation: [0, 0, 1, 0] })).toEqual({ ...trs, rotation: [0, 0, 1, 0] });
    expect(sheared.nodes[0]?.matrix).toEqual([...axes, 7, 8, 9, 1]);
  });

  it('knows of an image when it was named, and of none when it was taken away', () => {
    const named = withEdit(scene, { target: 'environment', image: 'sky.hdr' });
    expect(named.environment).toEqual({ rotation: 0, hasImage: true, image: 'sky.hdr' });
    expect(withEdit(named, { target: 'environment', rotation: 1 }).environment.hasImage).toBe(true);
    expect(withEdit(named, { target: 'environment', image: '' }).environment.hasImage).toBe(false);
  });

  it('shows the scene again as it is known, and not as one that was just joined', () => {
    const model = new Model();
    model.setScene(scene);
    model.applyLocally({ target: 'resolve', exposure: 1 });
    const shown: SceneMessage[] = [];
    model.on('scene', (again) => shown.push(again));
    model.showAgain();
    expect(shown.map(({ cause, resolve }) => [cause, resolve.exposure])).toEqual([['asked', 1]]);
  });

  it('keeps the selection through a description of the same scene, and drops it with another', () => {
    const model = new Model();
    model.setScene(scene);
    model.select({ kind: 'material', material: 1 });
    model.setScene({ ...scene, cause: 'asked' });
    expect(model.selection).toEqual({ kind: 'material', material: 1 });
    model.setScene({ ...scene, name: 'b.glb' });
    expect(model.selection).toEqual({ kind: 'nothing' });
  });
});

const picture = (presentedMs: number, steps: number, estimatedError: number, dropped = false, header = {}) =>
  ({
    header: {
      steps,
      meanSamples: steps,
      estimatedError,
      errorLow: 0,
      errorHigh: 1,
      msSinceEdit: 50,
      sceneRevision: 1,
      viewRevision: 1,
      ...header,
    } as FrameHeader,
    dropped,
    presentedMs,
    receivedMs: presentedMs,
    decodeMs: 1,
    bytes: 500,
  }) as FrameReport;

describe('Statistics', () => {
  it('begins the curve anew when the steps fall', () => {
    const s = new Statistics();
    s.onFrame(picture(1000, 1, Infinity));
    s.onFrame(picture(1100, 2, 0.5));
    s.onFrame(picture(1300, 4, 0.25));
    expect(s.errorPoints.map((p) => p.error)).toEqual([0.5, 0.25]);
    expect(s.errorPoints[0]?.seconds).toBeCloseTo(0.15, 9);
    s.onFrame(picture(2000, 1, 0.9));
    expect(s.errorPoints).toEqual([{ seconds: 0.05, error: 0.9, low: 0, high: 1 }]);
  });
  it.each([{ sceneRevision: 2 }, { viewRevision: 2 }])('begins the curve anew with %j', (revision) => {
    const s = new Statistics();
    s.onFrame(picture(1000, 3, 0.5));
    s.onFrame(picture(5000, 3, 0.4, false, revision));
    expect(s.errorPoints.map((p) => p.seconds)).toEqual([0.05]);
  });
  it('begins the curve anew with each restart of which no pass was finished', () => {
    const s = new Statistics();
    s.onFrame(picture(1000, 1, Infinity));
    s.onFrame(picture(5000, 1, Infinity)); // a parameter was changed
    s.onFrame(picture(5200, 2, 0.5, false, { msSinceEdit: 250 }));
    expect(s.errorPoints.map((p) => p.seconds)).toEqual([0.25]);
  });
  it('counts from the restart that was before joining, whatever was edited since', () => {
    const s = new Statistics();
    s.onConnected();
    s.onStatus({ secondsSinceRestart: 40 } as Status, 1000);
    s.onFrame(picture(1500, 90, 0.5));
    s.onStatus({ secondsSinceRestart: 41 } as Status, 2500);
    s.onFrame(picture(2500, 99, 0.4));
    expect(s.errorPoints.map((p) => p.seconds)).toEqual([40.5, 41.5]);
  });
  it('counts the first pass of a server on which nobody edited anything', () => {
    const s = new Statistics();
    s.onConnected();
    s.onStatus({ secondsSinceRestart: 0 } as Status, 1000);
    const untouched = { msSinceEdit: 0 };
    s.onFrame(picture(1500, 0, Infinity, false, untouched));
    s.onFrame(picture(4000, 1, Infinity, false, untouched));
    s.onFrame(picture(5000, 2, 0.5, false, untouched));
    expect(s.errorPoints.map((p) => p.seconds)).toEqual([4]);
  });
  it('counts rates over two seconds, dropped frames apart', () => {
    const s = new Statistics();
    for (let i = 0; i < 20; i++) s.onFrame(picture(1000 + i * 100, 1 + i, 1, i % 10 === 9));
    expect([s.presented, s.dropped]).toEqual([18, 2]);
    expect(s.framesPerSecond(2900)).toBe(9);
    expect(s.bytesPerSecond(2900)).toBe(5000);
    expect(s.framesPerSecond(9000)).toBe(0);
  });
  it('tells quantiles of the latency', () => {
    const s = new Statistics();
    expect(s.latencyQuantile(0.5)).toBeNaN();
    s.onLatencies([10, 40, 20, 30]);
    expect([s.latencyQuantile(0.5), s.latencyQuantile(0.95), s.lastLatency()]).toEqual([30, 40, 30]);
  });
  it('thins a long curve but keeps its ends', () => {
    const points = Array.from({ length: 601 }, (_, i) => ({ seconds: i, error: 1, low: 0, high: 2 }));
    const thinner = thin(points);
    expect(thinner.length).toBeLessThan(310);
    expect([thinner[0]?.seconds, thinner.at(-1)?.seconds]).toEqual([0, 600]);
  });
});

describe('Stage geometry', () => {
  it('fits and centres the picture', () => {
    expect(fitPicture({ left: 10, top: 0, width: 200, height: 100 }, 50, 50)).toEqual({
      left: 60,
      top: 0,
      width: 100,
      height: 100,
    });
  });
  it('finds the pixel under the pointer, and none beside the picture', () => {
    const shown = { left: 100, top: 50, width: 200, height: 100 };
    expect(pixelAt(shown, 400, 200, 100, 50)).toEqual({ x: 0, y: 0 });
    expect(pixelAt(shown, 400, 200, 299.9, 149.9)).toEqual({ x: 399, y: 199 });
    expect(pixelAt(shown, 400, 200, 300, 100)).toBeNull();
    expect(pixelAt(shown, 400, 200, 99, 100)).toBeNull();
  });
});

describe('Inputs', () => {
  it.each([
    { minimum: 0, maximum: 1 },
    { minimum: 0, maximum: 1e9, softMaximum: 20, logarithmic: true },
    { minimum: 1, maximum: 64, integer: true },
    { softMinimum: -8, softMaximum: 8 },
  ])('a slider over %j gives its ends back and rises', (options) => {
    const scale = sliderScale(options);
    const low = options.softMinimum ?? options.minimum ?? 0;
    const high = options.softMaximum ?? options.maximum ?? 1;
    expect([scale.valueAt(0), scale.valueAt(1000)]).toEqual([low, high]);
    expect([scale.positionOf(low), scale.positionOf(high), scale.positionOf(high * 2)]).toEqual([0, 1000, 1000]);
    expect(scale.valueAt(600)).toBeGreaterThan(scale.valueAt(400));
  });
  it.each([
    { minimum: 1, maximum: 64, integer: true },
    { minimum: 1, maximum: 1_048_576, integer: true, logarithmic: true },
  ])('an arrow key takes every whole number over %j to another', (options) => {
    const { nextInteger } = sliderScale(options);
    for (let value = options.minimum; value < 64; value++) {
      expect(nextInteger(value, 1)).toBeGreaterThan(value);
      expect(nextInteger(value + 1, -1)).toBeLessThan(value + 1);
    }
    expect([nextInteger(options.minimum, -1), nextInteger(options.maximum, 1)]).toEqual([
      options.minimum,
      options.maximum,
    ]);
  });
  it('an arrow key misses no whole number of a short range, and goes a slider step in a long one', () => {
    const short = sliderScale({ minimum: 1, maximum: 64, integer: true });
    expect([short.nextInteger(32, 1), short.nextInteger(32, -1)]).toEqual([33, 31]);
    const long = sliderScale({ minimum: 1, maximum: 1_048_576, integer: true, logarithmic: true });
    expect(long.nextInteger(500_000, 1)).toBe(long.valueAt(long.positionOf(500_000) + 1));
  });
  it('a share of the window keeps its shape, also where its longer side is too long', () => {
    expect(shareOfStage({ width: 801, height: 600 }, 0.5, 2048)).toEqual({ width: 401, height: 300 });
    expect(shareOfStage({ width: 4000, height: 1000 }, 1, 2000)).toEqual({ width: 2000, height: 500 });
    expect(shareOfStage({ width: 1000, height: 4000 }, 0.5, 1000)).toEqual({ width: 250, height: 1000 });
    expect(shareOfStage({ width: 300, height: 4 }, 1, 1000)).toEqual({ width: 300, height: 16 });
  });
  it('writes numbers for people', () => {
    expect([0, 0.25, 1234.5678, 1.5e-7, NaN].map((v) => formatNumber(v))).toEqual([
      '0',
      '0.25',
      '1235',
      '1.50e-7',
      '–',
    ]);
    expect([formatSeconds(0.1834), formatSeconds(42.13), formatSeconds(75)]).toEqual([
      '0.18 s',
      '42.1 s',
      '1 min 15 s',
    ]);
    expect([formatBytes(999), formatBytes(82_000), formatBytes(2.5e6)]).toEqual(['999 B', '82.0 kB', '2.50 MB']);
    expect(['baseColor', 'pbr-neutral', 'attenuationDistance', 'ior'].map(titleFromName)).toEqual([
      'Base color',
      'PBR neutral',
      'Attenuation distance',
      'IOR',
    ]);
  });
  it('takes whole decades for an axis', () => {
    expect(decades([0.02, 5])).toEqual({ low: -2, high: 1 });
    expect(decades([1])).toEqual({ low: 0, high: 1 });
    expect(decades([0, Infinity])).toEqual({ low: -1, high: 0 });
  });
});

describe('Announcer', () => {
  it('speaks at most every two seconds, the newest text', () => {
    vi.useFakeTimers();
    const said: string[] = [];
    const announcer = new Announcer(
      (text) => said.push(text),
      () => Date.now(),
    );
    ['a', 'b', 'c'].forEach((text) => announcer.say(text));
    expect(said).toEqual(['a']);
    vi.advanceTimersByTime(1999);
    expect(said).toEqual(['a']);
    vi.advanceTimersByTime(1);
    expect(said).toEqual(['a', 'c']);
    vi.useRealTimers();
  });
});
