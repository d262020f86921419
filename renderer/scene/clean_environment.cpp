#include "renderer/scene/clean_environment.hpp"

#include <cmath>
#include <memory>

namespace limn {

uint64_t cleanRadiance(Image& image) {
  uint64_t broken = 0;
  for (size_t i = 0; i < image.rgbaF.size(); ++i) {
    float& v = image.rgbaF[i];
    if (i % 4 == 3 || (std::isfinite(v) && v >= 0.0f)) continue;
    v = 0.0f;
    ++broken;
  }
  return broken;
}

void cleanEnvironment(Scene& scene, std::vector<std::string>& notes) {
  if (!scene.environment.image) return;
  Image image = *scene.environment.image;
  const uint64_t broken = cleanRadiance(image);
  if (broken > 0) scene.environment.image = std::make_shared<const Image>(std::move(image));
  noteCleaned(broken, notes);
}

void noteCleaned(uint64_t values, std::vector<std::string>& notes) {
  if (values > 0) notes.push_back(std::to_string(values) + " values of the environment that were not finite or negative became 0");
}

}  // namespace limn
