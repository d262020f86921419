// Unidirectional path tracing with next-event estimation and multiple importance sampling [Veach 1997]: the judge of the rest.
// One invocation takes `sampleCount` samples of one pixel, starting the next path as soon as one ends, so that lanes of a
// vector stay busy.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/bvh_shared.h"
#include "shaders/lib/scene_bindings.glsl"
#include "shaders/lib/film.glsl"
#include "shaders/lib/camera.glsl"
#include "shaders/lib/path.glsl"

layout(local_size_x = 64) in;
layout(binding = BINDING_PIXEL_LIST, scalar) readonly buffer PixelList { uint pixelList[]; };
layout(binding = BINDING_COUNTERS, scalar) buffer Counters { uint counters[]; };
layout(push_constant, scalar) uniform Push { PathTracingPush push; };

Path startPath(uint pixel, uint sampleIndex) {
  Path p = newPath(makeFilmSampler(pixel, sampleIndex, push.seed), push.maxBounces, push.rouletteStart);
  vec2 corner = vec2(pixel % camera.width, pixel / camera.width);
  cameraRay(corner + next2D(p.sampler_), p.originR, p.dirR);
  p.travelled = distanceToEye(p.originR);
  return p;
}

// Software devices give each of their threads one run of workgroups; dealt out in turn, cheap and dear parts of the picture
// share the threads evenly. The number of workgroups is a multiple of kDealt.
uint dealtEntry() {
  const uint kDealt = 8u;
  uint each = gl_NumWorkGroups.x / kDealt;
  uint group = (gl_WorkGroupID.x % each) * kDealt + gl_WorkGroupID.x / each;
  return group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}

void main() {
  uint entry = dealtEntry();
  uint discarded = 0u;
  if (entry < push.entryCount) {
    uint pixel = pixelList[push.firstEntry + entry];
    uint place = push.byEntry != 0u ? push.firstEntry + entry : pixel;
    FilmPixel film = readFilm(place);
    uint taken = 0u;
    Path p = startPath(pixel, push.firstSample);
    while (true) {
      if (advance(p)) continue;
      if (acceptable(p.result)) addSample(film, p.result, ((push.firstSample + taken) & 1u) == 0u);
      else ++discarded;
      if (++taken == push.sampleCount) break;
      p = startPath(pixel, push.firstSample + taken);
    }
    writeFilm(place, film);
  }
  if (traceCount > 0u) {
    uint before = atomicAdd(counters[kCounterRays], traceCount);
    if (before + traceCount < before) atomicAdd(counters[kCounterRays + 1u], 1u);
  }
  if (discarded > 0u) atomicAdd(counters[kCounterDiscarded], discarded);
}
