import { describe, expect, it } from 'vitest';
import { hexFromLinear, linearFromHex, linearFromSrgb, splitStrength, srgbFromLinear } from '../src/math/color';
import { localPlacement } from '../src/math/placement';
import { anglesOf, eulerFromQuat, quatFromEuler, type Quat } from '../src/math/rotation';
import type { Vec3 } from '../src/math/vec3';

describe('sRGB', () => {
  it('matches the published values', () => {
    expect(srgbFromLinear(0)).toBe(0);
    expect(srgbFromLinear(1)).toBeCloseTo(1, 12);
    expect(srgbFromLinear(0.2140411)).toBeCloseTo(0.5, 6);
    expect(linearFromSrgb(0.04045)).toBeCloseTo(0.0031308, 6);
  });
  it('gives every byte back', () => {
    for (let byte = 0; byte < 256; byte++) {
      const hex = '#' + byte.toString(16).padStart(2, '0').repeat(3);
      expect(hexFromLinear(linearFromHex(hex))).toBe(hex);
    }
  });
  it('splits a radiance into colour and strength', () => {
    expect(splitStrength([6, 3, 1.5])).toEqual({ color: [1, 0.5, 0.25], strength: 6 });
    expect(splitStrength([0, 0, 0])).toEqual({ color: [1, 1, 1], strength: 0 });
    expect(splitStrength([0, 0, 0], [1, 0.5, 0])).toEqual({ color: [1, 0.5, 0], strength: 0 });
  });
});

describe('rotation', () => {
  it.each<[Vec3]>([[[0, 0, 0]], [[30, -40, 50]], [[-170, 10, 95]], [[0, 89, 0]], [[120, -60, -30]]])(
    'angles %j come back',
    (angles) => {
      eulerFromQuat(quatFromEuler(angles)).forEach((a, i) => expect(a).toBeCloseTo(angles[i] ?? NaN, 8));
    },
  );
  it.each<[Vec3]>([[[20, 90, 0]], [[20, -90, 35]], [[-50, 90, 170]]])(
    'angles %j at the pole give the same rotation back',
    (angles) => {
      const q = quatFromEuler(angles);
      const again = quatFromEuler(eulerFromQuat(q));
      const cosine = q.reduce((sum, c, i) => sum + c * (again[i] ?? 0), 0);
      expect(Math.abs(cosine)).toBeCloseTo(1, 6);
    },
  );
  it('leaves shown angles that say the same, as the server rounds and signs it', () => {
    const shown: Vec3 = [0, 135, 0];
    const told = quatFromEuler(shown).map((c) => Math.fround(-c)) as unknown as Quat;
    expect(anglesOf(told, shown)).toBe(shown);
    expect(anglesOf(quatFromEuler([0, 135.01, 0]), shown)).toEqual([180, 44.99, 180]);
    expect(anglesOf(quatFromEuler([10, 20, 30]), shown)).toEqual([10, 20, 30]);
  });
  it('turns x to y by a quarter turn about z', () => {
    const rotation = quatFromEuler([0, 0, 90]);
    const { x } = localPlacement({ name: '', translation: [0, 0, 0], rotation: [...rotation], scale: [2, 1, 1] });
    expect(x[0]).toBeCloseTo(0, 12);
    expect(x[1]).toBeCloseTo(2, 12);
  });
});
