#pragma once
#include <string>

namespace limn {

/// Where pipelines are kept between runs, made if need be: $XDG_CACHE_HOME/limn, ~/.cache/limn, or empty: nowhere.
std::string cacheDirectory();

}  // namespace limn
