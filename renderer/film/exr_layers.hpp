#pragma once
#include <string>
#include <vector>

#include "renderer/film/film_image.hpp"

namespace limn {

/// The EXR channels of a layer, in the order of its data. DESIGN.md section 4.
std::vector<std::string> exrChannelNames(const FilmLayer& layer);

/// A layer and where its channels stand among a file's.
struct ExrLayerPlan {
  std::string name;
  std::vector<size_t> sources;  ///< index of each of the layer's channels in the file's channel list; 1 or 3
};
/// Every channel of the file in exactly one layer; "beauty" first, the others by name.
std::vector<ExrLayerPlan> planExrLayers(const std::vector<std::string>& channels);

}  // namespace limn
