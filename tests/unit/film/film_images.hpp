#pragma once
#include <cstdint>
#include <random>
#include <string>

#include "renderer/film/film_image.hpp"

namespace limn::test {

inline FilmLayer noiseLayer(const std::string& name, uint32_t channels, size_t pixels, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(-1.0f, 10.0f);
  FilmLayer layer{name, channels, std::vector<float>(pixels * channels)};
  for (float& v : layer.data) v = value(random);
  return layer;
}

/// Every layer of DESIGN.md section 4 with seeded noise, and metadata.
inline FilmImage noiseFilm(uint32_t width, uint32_t height, uint32_t seed) {
  FilmImage image{width, height, {}, {}};
  const size_t pixels = size_t(width) * height;
  for (const char* name : {"beauty", "direct", "indirect", "albedo", "normal"})
    image.layers.push_back(noiseLayer(name, 3, pixels, ++seed));
  for (const char* name : {"depth", "samples", "error"}) image.layers.push_back(noiseLayer(name, 1, pixels, ++seed));
  image.metadata = {{"limn:samples", "0:16"}, {"limn:sceneHash", "00ff00ff00ff00ff"},
                    {"limn:technique", "path-tracing"}};
  return image;
}

}  // namespace limn::test
