import type { Vec3 } from './vec3';

/** sRGB transfer function of one linear component in 0..1 (IEC 61966-2-1). */
export function srgbFromLinear(linear: number): number {
  const c = Math.min(1, Math.max(0, linear));
  return c <= 0.0031308 ? 12.92 * c : 1.055 * Math.pow(c, 1 / 2.4) - 0.055;
}

/** The inverse of srgbFromLinear. */
export function linearFromSrgb(encoded: number): number {
  const c = Math.min(1, Math.max(0, encoded));
  return c <= 0.04045 ? c / 12.92 : Math.pow((c + 0.055) / 1.055, 2.4);
}

/** "#rrggbb" of a linear Rec. 709 colour; components outside 0..1 are clipped. */
export function hexFromLinear(color: Vec3): string {
  const byte = (c: number) =>
    Math.round(srgbFromLinear(c) * 255)
      .toString(16)
      .padStart(2, '0');
  return '#' + color.map(byte).join('');
}

/** Linear Rec. 709 colour of "#rrggbb". */
export function linearFromHex(hex: string): Vec3 {
  const component = (at: number) => linearFromSrgb(parseInt(hex.slice(at, at + 2), 16) / 255);
  return [component(1), component(3), component(5)];
}

/** Splits a radiance into a colour whose largest component is 1 and a factor. Black: `hue` times 0. */
export function splitStrength(color: Vec3, hue: Vec3 = [1, 1, 1]): { color: Vec3; strength: number } {
  const strength = Math.max(...color);
  if (!(strength > 0)) return { color: hue, strength: 0 };
  return { color: [color[0] / strength, color[1] / strength, color[2] / strength], strength };
}
