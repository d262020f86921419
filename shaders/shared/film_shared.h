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
  uint byEntry;       // 0: the film holds every pixel; 1: it holds the entries of the list
};
LIMN_ASSERT_SIZE(PathTracingPush, 32);

// What an audit knows of a pixel: what is displayed there, and two independent means of unbiased samples.
struct AuditRecord {
  vec3 shown;      // radiance of the film [W/(sr m^2)]
  float shownCount;
  vec3 even;       // radiance, mean of even samples
  float evenCount;
  vec3 odd;        // radiance, mean of odd samples
  float oddCount;
  float squares;   // of the samples' luminance, around its mean, summed
};
LIMN_ASSERT_SIZE(AuditRecord, 52);

struct AuditPush {
  uint entryCount;  // of the list
};
LIMN_ASSERT_SIZE(AuditPush, 4);

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
  float radianceSum;  // of the mean, channels averaged
  float samples;
  float errorSum;     // of the relative squared errors of the means, a value a channel
  float squareSum;    // of their squares
};
LIMN_ASSERT_SIZE(TileError, 16);

// Relative squared errors by size: bin (log2(value) + kErrorLeastOctave) * kErrorBinsPerOctave.
LIMN_CONST_UINT(kErrorBins, 640u);
LIMN_CONST_UINT(kErrorBinsPerOctave, 8u);
LIMN_CONST_UINT(kErrorLeastOctave, 40u);

struct FilmErrorPush {
  uint width;          // [pixel]
  uint height;         // [pixel]
  uint stage;          // 0: mean, 1: sizes, 2: sums
  uint largestBin;     // values in later bins are left out of the sums
  float meanRadiance;  // of the picture, channels averaged
};
LIMN_ASSERT_SIZE(FilmErrorPush, 20);

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
