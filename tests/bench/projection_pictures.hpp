#pragma once
#include <glm/glm.hpp>

#include "renderer/film/compare.hpp"
#include "tests/bench/projection_results.hpp"

namespace limn::projection {

RadianceImage blankImage(uint32_t width, uint32_t height, glm::vec3 value);
void setPixel(RadianceImage& image, uint32_t x, uint32_t y, glm::vec3 value);
/// Every pixel becomes a square of `factor` pixels a side.
RadianceImage enlarged(const RadianceImage& image, uint32_t factor);
/// From left to right with white gaps; all are of one height. `white` is the radiance that is shown as such.
RadianceImage sideBySide(const std::vector<RadianceImage>& images, float white);
/// |a - b| times `factor`; both are of one size.
RadianceImage differenceOf(const RadianceImage& a, const RadianceImage& b, float factor);
RadianceImage meanOf(const RadianceImage& a, const RadianceImage& b);
double meanValue(const RadianceImage& image);
/// A layer of three channels. Errors: "bad-image" where there is none.
Result<RadianceImage> layerOf(const FilmImage& film, const std::string& layer);

/// Radiance times `exposure` as a PNG. Errors: "io".
Result<Picture> pictureOf(const std::string& file, const std::string& caption, const RadianceImage& image,
                          double exposure);

}  // namespace limn::projection
