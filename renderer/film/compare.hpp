#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "renderer/base/result.hpp"
#include "renderer/film/film_image.hpp"

namespace limn {

/// Radiance of three channels a pixel, row 0 on top: width*height*3 values [W·sr⁻¹·m⁻²].
struct RadianceView {
  uint32_t width = 0, height = 0;
  std::span<const float> values;
};
/// The layer "beauty", three channels. Errors: "bad-image" when there is none. The image must outlive the view.
Result<RadianceView> radianceOf(const FilmImage& image, const std::string& place);

/// What a picture is measured against. With two independent halves of the reference the reference's own noise leaves no
/// bias: E[(x−h0)(x−h1)] = (x−truth)². Squares are then replaced by that product, and mape is not defined.
struct Reference {
  RadianceView mean;
  std::optional<RadianceView> half0, half1;
};

/// All means are over pixels and channels; r is the reference, a the picture.
struct ErrorMetrics {
  double relMse = 0.0;           ///< mean((a−r)² / (r² + 0.01·mean(r)²)) without the 0.1 % largest quotients
  double relMseAll = 0.0;        ///< the same with every quotient
  double rmse = 0.0;             ///< sqrt(mean((a−r)²)) [W·sr⁻¹·m⁻²]; 0 where the halves' product has a negative mean
  std::optional<double> mape;    ///< mean(|a−r| / (|r| + 0.01·mean(r)))
  double psnr = 0.0;             ///< 10·log10(max(r)² / mse) [dB]; infinity when they are equal
  uint64_t nonFinite = 0;        ///< values of `a` that are NaN or infinite; each is an infinite quotient
};

/// The share of quotients that relMse leaves out: fireflies would else decide it alone.
constexpr double kDiscardedShare = 0.001;

/// Errors: "size" (pictures of different size), "bad-image" (a reference with NaN or infinity). Any thread.
Result<ErrorMetrics> compareImages(const RadianceView& picture, const Reference& reference);

/// (a−r)² / (r² + 0.01·mean(r)²) of every value, or the halves' product over the same denominator. Same errors.
Result<std::vector<double>> relativeSquares(const RadianceView& picture, const Reference& reference);

/// r² + 0.01·mean(r)² of every value: what those squares are divided by. Zero only where the reference is black all over.
std::vector<double> relativeDenominators(const Reference& reference);

/// Mean without the `discardedShare` of values that are largest in magnitude; at least one value stays.
double trimmedMean(std::vector<double> values, double discardedShare);

/// A picture that holds its values.
struct RadianceImage {
  uint32_t width = 0, height = 0;
  std::vector<float> values;
  RadianceView view() const { return {width, height, values}; }
};
/// A copy of what is looked at.
RadianceImage imageOf(const RadianceView& view);
/// An image whose pixels are the means of side x side blocks; blocks at the right and bottom may be smaller.
RadianceImage averageBlocks(const RadianceView& image, uint32_t side);
/// compareImages() after averaging blocks of 16x16: noise is nearly gone, bias stays.
Result<ErrorMetrics> compareLow(const RadianceView& picture, const Reference& reference);

/// A picture of where the error is: each pixel's mean quotient on a logarithmic scale from 10⁻⁴ (black) to 10 (pale
/// yellow), as sRGB bytes width*height*4. `quotients` as relativeSquares() gives them, negative ones count as their
/// magnitude.
std::vector<uint8_t> errorHeatmap(uint32_t width, uint32_t height, std::span<const double> quotients);
/// The colour of t in 0..1: dark to light with monotone luminance, readable without colour vision.
std::array<uint8_t, 3> heatColor(double t);

}  // namespace limn
