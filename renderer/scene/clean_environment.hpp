#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "renderer/scene/scene.hpp"

namespace limn {

/// Colours of a float image that are not finite or negative become 0; gives their number.
uint64_t cleanRadiance(Image& image);

/// Does so with the environment's image and says it in `notes`: one such texel would take the light of all others.
void cleanEnvironment(Scene& scene, std::vector<std::string>& notes);

/// "3 values of the environment that were not finite or negative became 0"; nothing for 0.
void noteCleaned(uint64_t values, std::vector<std::string>& notes);

}  // namespace limn
