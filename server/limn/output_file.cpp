#include "server/limn/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "renderer/base/file_bytes.hpp"

namespace limn {

Result<void> checkWritable(const std::filesystem::path& file) {
  std::error_code problem;
  const std::filesystem::path directory = file.parent_path();
  if (!directory.empty() && !std::filesystem::is_directory(directory, problem))
    return Error{"io", "no such directory", directory.string()};
  const std::filesystem::file_status there = std::filesystem::status(file, problem);
  if (std::filesystem::is_directory(there)) return Error{"io", "is a directory", file.string()};
  if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there))
    return Error{"io", "is not a regular file", file.string()};

  const std::filesystem::path beside = temporaryFor(file);
  const int made = open(beside.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  if (made < 0) return Error{"io", std::string("cannot be written: ") + std::strerror(errno), file.string()};
  close(made);
  unlink(beside.c_str());
  return {};
}

}  // namespace limn
