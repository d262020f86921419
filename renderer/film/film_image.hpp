#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace limn {

/// One named layer of a picture: row 0 on top, channels interleaved, 32-bit float.
struct FilmLayer {
  std::string name;                 ///< "beauty", "direct", "indirect", "albedo", "normal", "depth", "samples", "error"
  uint32_t channels = 3;            ///< 1 or 3
  std::vector<float> data;          ///< width*height*channels
};

/// What leaves the film. Radiance layers are linear Rec. 709 [W·sr⁻¹·m⁻²]; depth in m; error is each pixel's standard
/// error of the mean (luminance).
struct FilmImage {
  uint32_t width = 0, height = 0;   ///< [pixel]
  std::vector<FilmLayer> layers;
  /// "limn:sceneHash", "limn:seed", "limn:technique", "limn:samples" ("A:B"), "limn:seconds", "limn:version", ...
  std::vector<std::pair<std::string, std::string>> metadata;

  const FilmLayer* find(const std::string& name) const {
    for (const FilmLayer& layer : layers)
      if (layer.name == name) return &layer;
    return nullptr;
  }
};

}  // namespace limn
