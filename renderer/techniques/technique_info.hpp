#pragma once
#include <string>
#include <vector>

#include "renderer/scene/edit.hpp"

namespace limn {

enum class ParameterType { integer, real, boolean };

/// One knob of a technique, as announced to clients; panels are built from this and from nothing else.
struct ParameterInfo {
  std::string name;         ///< "maxBounces"
  std::string description;  ///< one sentence for people
  std::string unit;         ///< "bounces", "samples", "1" ...
  ParameterType type = ParameterType::real;
  double minimum = 0.0, maximum = 1.0, defaultValue = 0.0;
  CostClass cost = CostClass::regather;  ///< what a change restarts
};

struct TechniqueInfo {
  std::string name;         ///< "path-tracing"
  std::string title;        ///< "Path tracing"
  std::string description;
  bool biased = false;
  std::vector<ParameterInfo> parameters;
};

/// Every technique there is, in the order in which they are offered; the first is the default.
const std::vector<TechniqueInfo>& techniqueInfos();
const TechniqueInfo* findTechnique(std::string_view name);

}  // namespace limn
