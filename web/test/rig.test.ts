import { describe, expect, it } from 'vitest';
import { handleKey, handleObjectKey, type GestureTarget } from '../src/camera/controls';
import type { Pose } from '../src/camera/orbit';
import { CameraRig } from '../src/camera/rig';

const pose: Pose = {
  eye: [0, 0, 5],
  target: [0, 0, 0],
  up: [0, 1, 0],
  lens: { perspective: true, yfov: 1, ymag: 1, znear: 0.01 },
};
const box = { low: [-1, -1, -1] as const, high: [1, 1, 1] as const };

function makeRig(reducedMotion = true) {
  const sent: Pose[] = [];
  let queue: ((now: number) => void)[] = [];
  const rig = new CameraRig({
    send: (p) => sent.push(p),
    requestFrame: (callback) => queue.push(callback),
    reducedMotion: () => reducedMotion,
  });
  rig.adopt(pose);
  rig.setBounds(box);
  /** One display frame at a time [ms]. */
  const frame = (now: number) => {
    const due = queue;
    queue = [];
    for (const callback of due) callback(now);
    return due.length;
  };
  return { rig, sent, frame };
}

describe('CameraRig', () => {
  it('sends one pose for all gestures of a display frame', () => {
    const { rig, sent, frame } = makeRig();
    for (let i = 0; i < 10; i++) rig.orbit(0.01, 0);
    frame(100);
    expect(sent).toHaveLength(1);
    expect(sent[0]?.eye[0]).toBeCloseTo(5 * Math.sin(0.1), 9);
  });

  it('sends at most sixty a second on a faster display, and the last pose in the end', () => {
    const { rig, sent, frame } = makeRig();
    for (let now = 0; now < 1000; now += 1000 / 240) {
      rig.orbit(0.001, 0);
      frame(now);
    }
    expect(sent.length).toBeLessThanOrEqual(61);
    expect(sent.length).toBeGreaterThan(40);
    while (frame(2000) > 0);
    expect(sent.at(-1)).toEqual(rig.current());
  });

  it('sends nothing when nothing changed', () => {
    const { rig, sent, frame } = makeRig();
    rig.orbit(0, 0);
    frame(100);
    expect(sent).toHaveLength(0);
  });

  it('turns about the picked point', () => {
    const { rig } = makeRig();
    rig.setPivot({ point: [0, 0, 4], node: 0 });
    rig.orbit(Math.PI / 2, 0);
    expect(rig.current()?.eye[0]).toBeCloseTo(1, 9);
  });

  it('turns about the target of another view that was chosen', () => {
    const { rig } = makeRig();
    rig.setPivot({ point: [0, 0, 4], node: 0 });
    rig.lookFrom({ ...pose, eye: [3, 0, 0], target: [1, 0, 0] });
    expect(rig.pivot()).toEqual([1, 0, 0]);
  });

  it('travels over several frames to a framed view, or at once with reduced motion', () => {
    const slow = makeRig(false);
    slow.rig.frame();
    for (let now = 0; now < 1000; now += 20) slow.frame(now);
    expect(slow.sent.length).toBeGreaterThan(5);
    const quick = makeRig(true);
    quick.rig.frame();
    quick.frame(0);
    expect(quick.sent).toHaveLength(1);
    expect(quick.sent[0]?.eye[2]).toBeCloseTo(slow.sent.at(-1)?.eye[2] ?? NaN, 9);
  });

  it('frames the scene as it was told last, wherever the camera is then', () => {
    const { rig } = makeRig();
    rig.orbit(0.5, 0);
    const turned = rig.current();
    rig.setBounds({ low: [3, -1, -1], high: [5, 1, 1] });
    expect(rig.current()).toEqual(turned);
    rig.frame();
    expect(rig.current()?.target).toEqual([4, 0, 0]);
  });

  it('goes back to the first view of the scene', () => {
    const { rig, frame } = makeRig();
    rig.orbit(1, 0.2);
    frame(0);
    rig.reset();
    expect(rig.current()).toEqual(pose);
  });
});

describe('handleKey', () => {
  const calls: string[] = [];
  const note =
    (name: string) =>
    (...args: number[]) =>
      void calls.push([name, ...args.map(Math.sign)].join(' '));
  const target: GestureTarget = {
    pictureHeight: () => 100,
    orbit: note('orbit'),
    pan: note('pan'),
    moveObject: note('move'),
    dolly: (f) => void calls.push(f < 1 ? 'nearer' : 'farther'),
    click: note('click'),
    frame: note('frame'),
    centerPicked: note('center'),
    reset: note('reset'),
  };
  it.each([
    ['ArrowRight', false, 'orbit 1 0'],
    ['ArrowUp', false, 'orbit 0 -1'],
    ['ArrowRight', true, 'pan -1 0'],
    ['ArrowDown', true, 'pan 0 1'],
    ['+', false, 'nearer'],
    ['-', false, 'farther'],
    ['f', false, 'frame'],
    ['r', false, 'reset'],
    ['c', false, 'center'],
  ])('%s, shift %s: %s', (key, shift, expected) => {
    calls.length = 0;
    expect(handleKey(key, shift, target)).toBe(true);
    expect(calls.map((c) => c.replace(/-0/g, '0'))).toEqual([expected]);
  });
  it('leaves other keys alone', () => expect(handleKey('x', false, target)).toBe(false));
  it('moves the selected object by arrows alone', () => {
    calls.length = 0;
    expect(handleObjectKey('ArrowUp', target)).toBe(true);
    expect(handleObjectKey('+', target)).toBe(false);
    expect(calls).toEqual(['move 0 1']);
  });
});
