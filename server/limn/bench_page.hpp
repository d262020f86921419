#pragma once
#include <string>

#include "server/limn/bench_results.hpp"

namespace limn::bench {

/// One HTML page that needs nothing else: tables, pictures and heat maps as PNG in base64, and the plots whose SVG
/// files lie in `directory`.
std::string resultsPage(const BenchResults& results, const std::string& directory);

std::string base64(const std::string& bytes);

/// PNG bytes of linear radiance times `exposure`, as sRGB. Errors: "io".
Result<std::string> picturePng(const RadianceImage& picture, double exposure);
/// Exposure at which nine tenths of the values stay under 0.8; 1 for a black picture.
double exposureFor(const RadianceImage& picture);
/// PNG bytes of where `picture` errs. Errors: those of relativeSquares() and "io".
Result<std::string> heatPng(const RadianceImage& picture, const RadianceImage& reference);

}  // namespace limn::bench
