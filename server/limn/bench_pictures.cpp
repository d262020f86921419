#include <algorithm>
#include <cmath>

#include "renderer/film/exr.hpp"
#include "server/limn/bench_page.hpp"

namespace limn::bench {
namespace {

/// IEC 61966-2-1.
uint8_t srgbByte(double linear) {
  const double v = std::clamp(std::isfinite(linear) ? linear : 0.0, 0.0, 1.0);
  const double encoded = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
  return uint8_t(std::lround(encoded * 255.0));
}

Result<std::string> encoded(uint32_t width, uint32_t height, const std::vector<uint8_t>& rgba) {
  const Result<std::vector<uint8_t>> png = encodePng(width, height, rgba);
  if (!png) return png.error();
  return std::string(png->begin(), png->end());
}

}  // namespace

std::string base64(const std::string& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t have = std::min<size_t>(3, bytes.size() - i);
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k) word = word << 8 | (k < have ? uint8_t(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) text += k <= have ? kDigits[word >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

double exposureFor(const RadianceImage& picture) {
  std::vector<float> values = picture.values;
  std::erase_if(values, [](float v) { return !std::isfinite(v); });
  if (values.empty()) return 1.0;
  const auto ninth = values.begin() + std::ptrdiff_t(values.size() * 9 / 10);
  std::nth_element(values.begin(), ninth, values.end());
  return *ninth > 0.0f ? 0.8 / *ninth : 1.0;
}

Result<std::string> picturePng(const RadianceImage& picture, double exposure) {
  std::vector<uint8_t> rgba;
  rgba.reserve(picture.values.size() / 3 * 4);
  for (size_t i = 0; i < picture.values.size(); ++i) {
    rgba.push_back(srgbByte(picture.values[i] * exposure));
    if (i % 3 == 2) rgba.push_back(255);
  }
  return encoded(picture.width, picture.height, rgba);
}

Result<std::string> heatPng(const RadianceImage& picture, const RadianceImage& reference) {
  const Result<std::vector<double>> quotients = relativeSquares(picture.view(), {reference.view(), {}, {}});
  if (!quotients) return quotients.error();
  return encoded(picture.width, picture.height, errorHeatmap(picture.width, picture.height, *quotients));
}

}  // namespace limn::bench
