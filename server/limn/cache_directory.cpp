#include "server/limn/cache_directory.hpp"

#include <cstdlib>
#include <filesystem>

namespace limn {

std::string cacheDirectory() {
  const char* base = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  if (!base && !home) return "";
  const std::filesystem::path root = base ? std::filesystem::path(base) : std::filesystem::path(home) / ".cache";
  const std::filesystem::path path = root / "limn";
  std::error_code problem;
  std::filesystem::create_directories(path, problem);
  return problem ? "" : path.string();
}

}  // namespace limn
