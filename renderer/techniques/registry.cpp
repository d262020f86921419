#include "renderer/techniques/path_tracing.hpp"
#include "renderer/techniques/point_projection.hpp"
#include "renderer/techniques/technique.hpp"

namespace limn {

const std::vector<TechniqueInfo>& techniqueInfos() {
  static const std::vector<TechniqueInfo> kInfos{pathTracingInfo(), pointProjectionInfo()};
  return kInfos;
}

std::unique_ptr<Technique> makeTechnique(std::string_view name) {
  if (name == pathTracingInfo().name) return makePathTracing();
  if (name == pointProjectionInfo().name) return makePointProjection();
  return nullptr;
}

const TechniqueInfo* findTechnique(std::string_view name) {
  for (const TechniqueInfo& info : techniqueInfos())
    if (info.name == name) return &info;
  return nullptr;
}

}  // namespace limn
