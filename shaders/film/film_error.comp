// How wrong the film is, from the two halves of each pixel's samples: they disagree by as much as their mean errs. Stage 0 sums
// the mean over tiles of 16x16 pixels, stage 1 counts the relative squared errors by size, stage 2 sums all but the largest.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/film.glsl"
#include "shaders/lib/math.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(binding = BINDING_OUTPUT, scalar) buffer Tiles { TileError tiles[]; };
layout(binding = BINDING_COUNTERS, scalar) buffer Sizes { uint sizes[]; };  // values in each bin of errorBin()
layout(push_constant, scalar) uniform Push { FilmErrorPush push; };

shared vec4 partial[256];
shared uint ownSizes[kErrorBins];

// The sum over the tile, known to every invocation.
vec4 sumOverTile(vec4 value) {
  uint l = gl_LocalInvocationIndex;
  partial[l] = value;
  for (uint step = 128u; step > 0u; step >>= 1) {
    barrier();
    if (l < step) partial[l] += partial[l + step];
  }
  barrier();
  return partial[0];
}

uint errorBin(float value) {
  return uint(clamp((log2(max(value, 1e-37)) + kErrorLeastOctave) * kErrorBinsPerOctave, 0.0, float(kErrorBins - 1u)));
}

// Squared error of a mean, and whether it is known.
bool squaredError(uint pixel, vec4 mean, out vec3 square) {
  float evenCount = filmDirect[pixel].w, oddCount = mean.w - evenCount;
  square = vec3(0.0);
  if (!(evenCount > 0.0 && oddCount > 0.0)) return false;
  vec3 even = filmHalf[pixel].rgb;
  vec3 odd = (mean.rgb * mean.w - even * evenCount) / oddCount;
  vec3 e = (even - odd) * (sqrt(evenCount * oddCount) / mean.w);
  square = e * e;
  return true;
}

// What two pixels of one piece of surface may differ by: albedo, depth by a share, normal by length.
const float kLikeAlbedo = 0.02, kLikeDepth = 0.03, kLikeNormal = 0.1;
// And two pixels of surfaces in about the same indirect light: albedo by a factor.
const float kNearAlbedo = 4.0, kNearDepth = 0.1, kNearNormal = 0.5;
// Direct light that a pixel around has too is no single bright path; less than this share of it is not expected. Measured.
const float kLeastOfDirect = 0.5;

bool isClose(uint a, uint b, float depth, float normal) {
  float depthA = filmAlbedo[a].w, depthB = filmAlbedo[b].w;
  return abs(depthA - depthB) < depth * depthA && distance(filmNormal[a], filmNormal[b]) < normal;
}

vec3 albedoAt(uint pixel) { return filmAlbedo[pixel].rgb; }
vec3 directAt(uint pixel) { return filmDirect[pixel].rgb; }
vec3 indirectAt(uint pixel) { return max(filmMean[pixel].rgb - filmDirect[pixel].rgb, vec3(0.0)); }

// Whether both pixels show one piece of surface: lights and edges are no noise.
bool alike(uint a, uint b) {
  return maxComponent(abs(albedoAt(a) - albedoAt(b))) < kLikeAlbedo && isClose(a, b, kLikeDepth, kLikeNormal);
}

// Whether indirect light at one tells that at the other: `tint` is its colour over the other's.
bool alikeButForColour(uint a, uint b, out vec3 tint) {
  tint = (albedoAt(a) + kLikeAlbedo) / (albedoAt(b) + kLikeAlbedo);
  return maxComponent(max(tint, 1.0 / tint)) < kNearAlbedo && isClose(a, b, kNearDepth, kNearNormal);
}

// What the pixels around show, without the one in the middle.
struct Around {
  vec3 direct, indirect;  // radiance, means over those that are alike
  vec3 largestDirect;     // of all of them
};

// Where none is alike, as on textures and bumps, indirect light of others counts in the colour of the one in the middle, whose
// direct light is what it is: it may be a lamp. A pixel that is alone is all there is around it.
Around lookAround(uvec2 middle, uint pixel) {
  const int kReach = 1;
  Around a = Around(vec3(0.0), vec3(0.0), vec3(0.0));
  vec3 tinted = vec3(0.0), tint;
  float count = 0.0, tintedCount = 0.0;
  for (int y = -kReach; y <= kReach; ++y)
    for (int x = -kReach; x <= kReach; ++x) {
      ivec2 p = ivec2(middle) + ivec2(x, y);
      if ((x == 0 && y == 0) || p.x < 0 || p.y < 0 || p.x >= int(push.width) || p.y >= int(push.height)) continue;
      uint other = uint(p.y) * push.width + uint(p.x);
      if (filmMean[other].w == 0.0) continue;
      a.largestDirect = max(a.largestDirect, directAt(other));
      if (alikeButForColour(pixel, other, tint)) tinted += tint * indirectAt(other), tintedCount += 1.0;
      if (!alike(pixel, other)) continue;
      a.direct += directAt(other);
      a.indirect += indirectAt(other);
      count += 1.0;
    }
  if (count > 0.0) return Around(a.direct / count, a.indirect / count, a.largestDirect);
  return Around(directAt(pixel), tintedCount > 0.0 ? tinted / tintedCount : indirectAt(pixel), directAt(pixel));
}

// By as much as noise may explain the difference, what is around is believed. [Efron, Morris 1973]
vec3 shrunk(vec3 middle, vec3 around, vec3 noise) {
  vec3 difference = middle - around;
  vec3 spread = max(difference * difference - noise, vec3(0.0));
  return around + spread / max(spread + noise, vec3(1e-37)) * difference;
}

// The square of what the truth is likely to be: a pixel that one bright path has lifted would hide its error behind its own
// mean.
vec3 squareOfTruth(uint pixel, Around around, vec3 noise) {
  vec3 direct = max(shrunk(directAt(pixel), around.direct, noise), kLeastOfDirect * min(directAt(pixel), around.largestDirect));
  vec3 expected = direct + shrunk(indirectAt(pixel), around.indirect, noise);
  return expected * expected;
}

void writeSizes(bool known, vec3 relative) {
  uint l = gl_LocalInvocationIndex;
  for (uint bin = l; bin < kErrorBins; bin += 256u) ownSizes[bin] = 0u;
  barrier();
  if (known)
    for (int c = 0; c < 3; ++c) atomicAdd(ownSizes[errorBin(relative[c])], 1u);
  barrier();
  for (uint bin = l; bin < kErrorBins; bin += 256u)
    if (ownSizes[bin] > 0u) atomicAdd(sizes[bin], ownSizes[bin]);
}

void main() {
  uvec2 p = gl_GlobalInvocationID.xy;
  uint pixel = p.y * push.width + p.x, tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  bool inside = p.x < push.width && p.y < push.height;
  vec4 mean = inside ? filmMean[pixel] : vec4(0.0);
  if (mean.w == 0.0) mean.rgb = vec3(0.0);
  if (push.stage == 0u) {
    vec4 all = sumOverTile(mean);
    if (gl_LocalInvocationIndex == 0u) tiles[tile] = TileError((all.r + all.g + all.b) * (1.0 / 3.0), all.w, 0.0, 0.0);
    return;
  }

  vec3 square = vec3(0.0), relative = vec3(0.0);
  bool known = inside && squaredError(pixel, mean, square);
  if (known)
    relative = square / (squareOfTruth(pixel, lookAround(p, pixel), square) + 0.01 * push.meanRadiance * push.meanRadiance + 1e-30);
  if (push.stage == 1u) {
    writeSizes(known, relative);
    return;
  }
  vec4 own = vec4(0.0);
  if (known)
    for (int c = 0; c < 3; ++c)
      if (errorBin(relative[c]) <= push.largestBin) own.xy += vec2(relative[c], relative[c] * relative[c]);
  vec4 sums = sumOverTile(own);
  if (gl_LocalInvocationIndex == 0u) {
    tiles[tile].errorSum = sums.x;
    tiles[tile].squareSum = sums.y;
  }
}
