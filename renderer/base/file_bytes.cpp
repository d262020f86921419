#include "renderer/base/file_bytes.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace limn {
namespace {

struct CloseFile {
  void operator()(FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<FILE, CloseFile>;

Error ioError(const std::filesystem::path& file, const std::string& what) { return {"io", what, file.string()}; }

/// The new name outlives a loss of power. Where a directory cannot be synced there is nothing to be done about it.
void syncDirectory(const std::filesystem::path& directory) {
  const int fd = open(directory.empty() ? "." : directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  (void)!fsync(fd);
  close(fd);
}

}  // namespace

std::filesystem::path temporaryFor(const std::filesystem::path& file) {
  std::filesystem::path beside = file;
  beside += ".tmp." + std::to_string(getpid());
  return beside;
}

Result<void> writeFileAtomically(const std::filesystem::path& file, std::span<const uint8_t> bytes) {
  const std::filesystem::path beside = temporaryFor(file);
  File out(std::fopen(beside.c_str(), "wb"));
  if (!out) return ioError(file, std::string("cannot be written: ") + std::strerror(errno));
  bool written = std::fwrite(bytes.data(), 1, bytes.size(), out.get()) == bytes.size();
  written = std::fflush(out.get()) == 0 && written;
  written = fsync(fileno(out.get())) == 0 && written;
  const int why = errno;
  out.reset();
  if (written && std::rename(beside.c_str(), file.c_str()) == 0) {
    syncDirectory(file.parent_path());
    return {};
  }
  const std::string reason = std::strerror(written ? errno : why);
  std::remove(beside.c_str());
  return ioError(file, "cannot be written: " + reason);
}

Result<std::vector<uint8_t>> readFileBytes(const std::filesystem::path& file, uint64_t mostBytes) {
  std::error_code problem;
  if (!std::filesystem::is_regular_file(file, problem))
    return ioError(file, std::filesystem::exists(file, problem) ? "is not a regular file" : "no such file");
  const uint64_t size = std::filesystem::file_size(file, problem);
  if (problem) return ioError(file, problem.message());
  if (size > mostBytes)
    return Error{"limit", std::to_string(size) + " bytes, the limit is " + std::to_string(mostBytes), file.string()};
  File in(std::fopen(file.c_str(), "rb"));
  if (!in) return ioError(file, std::string("cannot be read: ") + std::strerror(errno));
  std::vector<uint8_t> bytes(size);
  if (std::fread(bytes.data(), 1, size, in.get()) != size) return ioError(file, "ends early");
  return bytes;
}

}  // namespace limn
