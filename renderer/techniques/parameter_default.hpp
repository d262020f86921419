#pragma once
#include <algorithm>
#include <string_view>

#include "renderer/base/check.hpp"
#include "renderer/techniques/technique_info.hpp"

namespace limn {

/// Of a parameter that the technique has.
inline double defaultOf(const TechniqueInfo& info, std::string_view parameter) {
  const auto found = std::find_if(info.parameters.begin(), info.parameters.end(),
                                  [&](const ParameterInfo& p) { return p.name == parameter; });
  LIMN_CHECK(found != info.parameters.end());
  return found->defaultValue;
}

}  // namespace limn
