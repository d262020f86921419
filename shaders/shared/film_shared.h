// Film, passes and counters, as C++ and GLSL see them.
#ifndef LIMN_FILM_SHARED_H
#define LIMN_FILM_SHARED_H
#include "shaders/shared/shared.h"
#ifndef LIMN_GLSL
namespace limn::shared {
#endif

// Words of the counter buffer; 64-bit values are two words, low first.
LIMN_CONST_UINT(kCounterRays, 0u);       // low word; high word follows
LIMN_CONST_UINT(kCounterDiscarded, 2u);  // samples that were NaN, infinite or negative
LIMN_CONST_UINT(kCounterWords, 16u);

struct PathTracingPush {
  uint firstEntry;    // of the pixel list
  uint entryCount;    // pixels of this dispatch
  uint firstSample;   // sample index of the first sample taken of every pixel
  uint sampleCount;   // samples taken of every pixel
  uint seed;
  uint maxBounces;    // indirect bounces; 0: direct light only
  uint rouletteStart; // bounces before Russian roulette
};
LIMN_ASSERT_SIZE(PathTracingPush, 28);

LIMN_CONST_UINT(kViewBeauty, 0u);
LIMN_CONST_UINT(kViewDirect, 1u);
LIMN_CONST_UINT(kViewIndirect, 2u);
LIMN_CONST_UINT(kViewAlbedo, 3u);
LIMN_CONST_UINT(kViewNormal, 4u);
LIMN_CONST_UINT(kViewDepth, 5u);
LIMN_CONST_UINT(kViewSamples, 6u);
LIMN_CONST_UINT(kViewPlacement, 7u);   // the picture, tinted by IndirectTexel.state
LIMN_CONST_UINT(kViewOwnSamples, 8u);  // the same where nothing is interpolated: tinted by whether a pixel has samples

struct ResolvePush {
  uint width;       // [pixel]
  uint height;      // [pixel]
  uint stride;      // pixels without samples are filled from the grid of every stride-th pixel
  uint toneMap;     // limn::ToneMap
  float exposure;   // factor on radiance
  uint view;        // limn::ResolveView as kView...
};
LIMN_ASSERT_SIZE(ResolvePush, 24);

// Film error reduction: one record for every 16x16 tile.
struct TileError {
  float luminanceSum;  // of the mean, all channels
  float errorSum;      // of the relative squared error of the mean
  float pixels;
  float samples;
};
LIMN_ASSERT_SIZE(TileError, 16);

struct SelectPush {
  uint width;
  uint height;
  uint minSamples;    // a pixel below this is active
  uint tileCount;
  float threshold;    // relative standard error of the mean under which a neighbourhood is done
  uint stage;         // kSelect...
  float meanLuminance;
};
LIMN_ASSERT_SIZE(SelectPush, 28);

#ifndef LIMN_GLSL
}  // namespace limn::shared
#endif
#endif
