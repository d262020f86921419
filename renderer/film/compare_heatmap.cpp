#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/film/compare.hpp"

namespace limn {
namespace {

constexpr double kLowestExponent = -4.0, kHighestExponent = 1.0;

/// CIE L*a*b*, D65.
struct Lab {
  double lightness, a, b;
};

double srgbEncoded(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
}

double labInverse(double t) {
  constexpr double kKnee = 6.0 / 29.0;
  return t > kKnee ? t * t * t : 3.0 * kKnee * kKnee * (t - 4.0 / 29.0);
}

std::array<uint8_t, 3> toBytes(const Lab& lab) {
  const double fy = (lab.lightness + 16.0) / 116.0;
  const double x = 0.95047 * labInverse(fy + lab.a / 500.0);
  const double y = labInverse(fy);
  const double z = 1.08883 * labInverse(fy - lab.b / 200.0);
  const double linear[3] = {3.2404542 * x - 1.5371385 * y - 0.4985314 * z,
                            -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
                            0.0556434 * x - 0.2040259 * y + 1.0572252 * z};
  std::array<uint8_t, 3> bytes{};
  for (size_t c = 0; c < 3; ++c) bytes[c] = uint8_t(std::lround(255.0 * srgbEncoded(linear[c])));
  return bytes;
}

}  // namespace

std::array<uint8_t, 3> heatColor(double t) {
  // Lightness rises evenly; hue walks from violet over red and orange to yellow; chroma vanishes at both ends.
  const double x = std::clamp(t, 0.0, 1.0);
  const double hue = (-65.0 + 165.0 * x) * 3.14159265358979323846 / 180.0;
  const double chroma = 64.0 * std::pow(std::sin(3.14159265358979323846 * std::pow(x, 0.85)), 0.7);
  return toBytes({96.0 * x, chroma * std::cos(hue), chroma * std::sin(hue)});
}

std::vector<uint8_t> errorHeatmap(uint32_t width, uint32_t height, std::span<const double> quotients) {
  LIMN_CHECK_EQ(quotients.size(), size_t(width) * height * 3);
  std::vector<uint8_t> rgba;
  rgba.reserve(size_t(width) * height * 4);
  for (size_t i = 0; i < quotients.size(); i += 3) {
    const double mean = (std::abs(quotients[i]) + std::abs(quotients[i + 1]) + std::abs(quotients[i + 2])) / 3.0;
    const double exponent = std::log10(std::max(mean, 1e-300));
    const std::array<uint8_t, 3> color = heatColor((exponent - kLowestExponent) / (kHighestExponent - kLowestExponent));
    rgba.insert(rgba.end(), {color[0], color[1], color[2], 255});
  }
  return rgba;
}

}  // namespace limn
