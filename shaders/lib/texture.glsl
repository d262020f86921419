// Textures out of the texel heap: wrap, bilinear filter, sRGB decoding. No mip levels: every sample has its own point of a pixel.
#ifndef LIMN_TEXTURE_GLSL
#define LIMN_TEXTURE_GLSL

int wrapTexel(int i, int size, uint mode) {
  if (mode == 1u) return clamp(i, 0, size - 1);
  int period = mode == 2u ? 2 * size : size;
  int r = i % period;
  r = r < 0 ? r + period : r;
  return r < size ? r : period - 1 - r;
}

vec3 srgbToLinear(vec3 c) {
  return mix(c * (1.0 / 12.92), pow((c + 0.055) * (1.0 / 1.055), vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

vec4 fetchTexel(ImageInfo image, int x, int y, uint sampler_) {
  x = wrapTexel(x, int(image.width), sampler_ & 3u);
  y = wrapTexel(y, int(image.height), (sampler_ >> 2) & 3u);
  vec4 c = unpackUnorm4x8(texelFetch(texels, int(image.firstTexel) + y * int(image.width) + x).x);
  return (sampler_ & kSamplerSrgb) != 0u ? vec4(srgbToLinear(c.rgb), c.a) : c;
}

// Filtered texel at the slot's transform of (uv0 | uv1). White when the slot is empty.
vec4 sampleTexture(TextureSlot slot, vec2 uv0, vec2 uv1) {
  if (slot.image == kNoIndex) return vec4(1.0);
  vec3 uv = vec3((slot.sampler_ & kSamplerTexCoord1) != 0u ? uv1 : uv0, 1.0);
  ImageInfo image = images[slot.image];
  vec2 size = vec2(image.width, image.height);
  // Coordinates a float cannot resolve to a texel have no answer; the fraction keeps the rest exact.
  vec2 st = vec2(dot(slot.rowU, uv), dot(slot.rowV, uv));
  st = clamp(st, vec2(-32768.0), vec2(32768.0)) * size;
  if ((slot.sampler_ & kSamplerNearest) != 0u) {
    ivec2 p = ivec2(floor(st));
    return fetchTexel(image, p.x, p.y, slot.sampler_);
  }
  st -= 0.5;
  vec2 base = floor(st), f = st - base;
  ivec2 p = ivec2(base);
  vec4 a = mix(fetchTexel(image, p.x, p.y, slot.sampler_), fetchTexel(image, p.x + 1, p.y, slot.sampler_), f.x);
  vec4 b = mix(fetchTexel(image, p.x, p.y + 1, slot.sampler_), fetchTexel(image, p.x + 1, p.y + 1, slot.sampler_), f.x);
  return mix(a, b, f.y);
}

#endif
