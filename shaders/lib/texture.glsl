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

// Filtered texel at the slot's transform of (uv0 | uv1).
vec4 sampleTexture(TextureSlot slot, vec2 uv0, vec2 uv1) {
  vec3 uv = vec3((slot.sampler_ & kSamplerTexCoord1) != 0u ? uv1 : uv0, 1.0);
  ImageInfo image = images[slot.image];
  // Coordinates so large that a float cannot resolve a texel have no right answer.
  vec2 st = clamp(vec2(dot(slot.rowU, uv), dot(slot.rowV, uv)), vec2(-32768.0), vec2(32768.0)) * vec2(image.width, image.height);
  bool nearest = (slot.sampler_ & kSamplerNearest) != 0u;
  st -= nearest ? 0.0 : 0.5;
  vec2 base = floor(st), f = nearest ? vec2(0.0) : st - base;
  ivec2 p = ivec2(base);
  vec4 sum = vec4(0.0);
  for (int k = 0; k < 4; ++k) {
    int dx = k & 1, dy = k >> 1;
    float w = (dx == 1 ? f.x : 1.0 - f.x) * (dy == 1 ? f.y : 1.0 - f.y);
    sum += w * fetchTexel(image, p.x + dx, p.y + dy, slot.sampler_);
  }
  return sum;
}

#endif
