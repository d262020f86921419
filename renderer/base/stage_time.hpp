#pragma once
#include <string>

namespace limn {

/// How long a named part of the work took [ms].
struct StageTime { std::string name; float ms = 0.0f; };

}  // namespace limn
