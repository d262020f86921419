#include "tests/bench/projection_pictures.hpp"

#include <cmath>
#include <numeric>

#include "server/limn/bench_page.hpp"

namespace limn::projection {
namespace {

constexpr uint32_t kGap = 8;  // [pixel] between pictures side by side

void paste(RadianceImage& onto, const RadianceImage& image, uint32_t left) {
  for (uint32_t y = 0; y < image.height; ++y)
    for (size_t i = 0; i < size_t(image.width) * 3; ++i)
      onto.values[(size_t(y) * onto.width + left) * 3 + i] = image.values[size_t(y) * image.width * 3 + i];
}

}  // namespace

RadianceImage blankImage(uint32_t width, uint32_t height, glm::vec3 value) {
  RadianceImage image{width, height, std::vector<float>(size_t(width) * height * 3)};
  for (size_t i = 0; i < image.values.size(); ++i) image.values[i] = value[int(i % 3)];
  return image;
}

void setPixel(RadianceImage& image, uint32_t x, uint32_t y, glm::vec3 value) {
  for (size_t c = 0; c < 3; ++c) image.values[(size_t(y) * image.width + x) * 3 + c] = value[int(c)];
}

RadianceImage enlarged(const RadianceImage& image, uint32_t factor) {
  RadianceImage large = blankImage(image.width * factor, image.height * factor, glm::vec3(0.0f));
  for (uint32_t y = 0; y < large.height; ++y)
    for (uint32_t x = 0; x < large.width; ++x) {
      const float* from = &image.values[(size_t(y / factor) * image.width + x / factor) * 3];
      setPixel(large, x, y, {from[0], from[1], from[2]});
    }
  return large;
}

RadianceImage sideBySide(const std::vector<RadianceImage>& images, float white) {
  uint32_t width = kGap * uint32_t(images.size() - 1);
  for (const RadianceImage& image : images) width += image.width;
  RadianceImage all = blankImage(width, images.front().height, glm::vec3(white));
  uint32_t left = 0;
  for (const RadianceImage& image : images) {
    paste(all, image, left);
    left += image.width + kGap;
  }
  return all;
}

RadianceImage differenceOf(const RadianceImage& a, const RadianceImage& b, float factor) {
  RadianceImage difference = a;
  for (size_t i = 0; i < a.values.size(); ++i) difference.values[i] = factor * std::abs(a.values[i] - b.values[i]);
  return difference;
}

RadianceImage meanOf(const RadianceImage& a, const RadianceImage& b) {
  RadianceImage mean = a;
  for (size_t i = 0; i < a.values.size(); ++i) mean.values[i] = 0.5f * (a.values[i] + b.values[i]);
  return mean;
}

double meanValue(const RadianceImage& image) {
  return std::accumulate(image.values.begin(), image.values.end(), 0.0) / double(image.values.size());
}

Result<RadianceImage> layerOf(const FilmImage& film, const std::string& layer) {
  const FilmLayer* found = film.find(layer);
  if (!found || found->channels != 3) return Error{"bad-image", "the film has no such layer of colours", layer};
  return RadianceImage{film.width, film.height, found->data};
}

Result<Picture> pictureOf(const std::string& file, const std::string& caption, const RadianceImage& image,
                          double exposure) {
  Result<std::string> png = bench::picturePng(image, exposure);
  if (!png) return png.error();
  return Picture{file, caption, png.take()};
}

}  // namespace limn::projection
