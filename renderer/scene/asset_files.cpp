#include "renderer/scene/asset_files.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <linux/openat2.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace limn {
namespace {

// O_NONBLOCK: opening a FIFO must not wait for its writer.
constexpr int kFileFlags = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;

Error fault(int number, const std::string& name) {
  switch (number) {
    case EXDEV: return {"path", "\"" + name + "\" leaves the asset root", ""};
    case ELOOP: return {"path", "\"" + name + "\" is or passes a symbolic link, which is not followed", ""};
    case ENOENT: return {"io", "\"" + name + "\" is not there", ""};
    case ENXIO: return {"path", "\"" + name + "\" is not a regular file", ""};
    default: return {"io", "\"" + name + "\" cannot be opened: " + std::strerror(number), ""};
  }
}

/// Takes the descriptor over if it is a regular file within the limit.
Result<FileReader> adopt(int descriptor, const std::string& name, uint64_t maxBytes) {
  struct stat facts {};
  const bool known = fstat(descriptor, &facts) == 0;
  FileReader reader(descriptor, known ? uint64_t(facts.st_size) : 0);
  if (!known) return fault(errno, name);
  if (!S_ISREG(facts.st_mode)) {
    return Error{"path", "\"" + name + "\" is " + (S_ISDIR(facts.st_mode) ? "a directory" : "not a regular file"), ""};
  }
  if (reader.size() > maxBytes) {
    return Error{
        "limit",
        "\"" + name + "\" has " + std::to_string(reader.size()) + " bytes, the limit is " + std::to_string(maxBytes),
        ""};
  }
  return reader;
}

/// Null when the text can be a path below a folder.
const char* unfit(const std::string& relative) {
  if (relative.empty()) return "an empty path names no file";
  if (relative.find('\0') != std::string::npos) return "a path with a zero byte names no file";
  if (relative.front() == '/') return "an absolute path leaves the asset root";
  return nullptr;
}

int openBeneath(int folder, const std::string& relative) {
  open_how how{};
  how.flags = uint64_t(kFileFlags);
  how.resolve = RESOLVE_BENEATH | RESOLVE_NO_SYMLINKS | RESOLVE_NO_MAGICLINKS;
  for (int attempt = 0; attempt < 64; ++attempt) {
    const long descriptor = syscall(SYS_openat2, folder, relative.c_str(), &how, sizeof how);
    // EAGAIN: something was renamed meanwhile and the kernel could not be sure that ".." stayed below.
    if (descriptor >= 0 || (errno != EAGAIN && errno != EINTR)) return int(descriptor);
  }
  errno = EXDEV;
  return -1;
}

/// The components with "." and ".." resolved as text; nothing when they leave the folder.
std::optional<std::vector<std::string>> componentsOf(const std::string& relative) {
  std::vector<std::string> parts;
  for (const std::filesystem::path& part : std::filesystem::path(relative)) {
    if (part.empty() || part == ".") continue;
    if (part != "..") {
      parts.push_back(part.string());
    } else if (parts.empty()) {
      return std::nullopt;
    } else {
      parts.pop_back();
    }
  }
  return parts;
}

}  // namespace

FileReader::~FileReader() {
  if (m_descriptor >= 0) close(m_descriptor);
}

Result<std::vector<uint8_t>> FileReader::read(uint64_t offset, uint64_t count) const {
  if (offset > m_size || count > m_size - offset) return Error{"io", "the file is shorter than asked for", ""};
  std::vector<uint8_t> bytes(count);
  for (uint64_t done = 0; done < count;) {
    const ssize_t got = pread(m_descriptor, bytes.data() + done, count - done, off_t(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return Error{"io", std::string("cannot be read: ") + std::strerror(errno), ""};
    if (got == 0) return Error{"io", "the file became shorter while it was read", ""};
    done += uint64_t(got);
  }
  return bytes;
}

Result<AssetRoot> AssetRoot::open(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::path real = std::filesystem::canonical(folder.empty() ? "." : folder, failure);
  if (failure)
    return Error{"io", "the folder \"" + folder.filename().string() + "\" cannot be found: " + failure.message(), ""};
  const int descriptor = ::open(real.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return fault(errno, folder.filename().string());
  return AssetRoot(descriptor, std::move(real));
}

AssetRoot::~AssetRoot() {
  if (m_descriptor >= 0) close(m_descriptor);
}

Result<FileReader> AssetRoot::openFile(const std::string& relative, uint64_t maxBytes) const {
  if (const char* why = unfit(relative)) return Error{"path", why, ""};
  const int descriptor = openBeneath(m_descriptor, relative);
  if (descriptor >= 0) return adopt(descriptor, relative, maxBytes);
  if (errno == ENOSYS || errno == EPERM) return openFileByComponents(relative, maxBytes);  // EPERM: a seccomp filter
  return fault(errno, relative);
}

Result<FileReader> AssetRoot::openFileByComponents(const std::string& relative, uint64_t maxBytes) const {
  if (const char* why = unfit(relative)) return Error{"path", why, ""};
  const auto parts = componentsOf(relative);
  if (!parts) return fault(EXDEV, relative);
  if (parts->empty()) return Error{"path", "\"" + relative + "\" is a directory", ""};

  int folder = fcntl(m_descriptor, F_DUPFD_CLOEXEC, 0);
  for (size_t i = 0; i + 1 < parts->size() && folder >= 0; ++i) {
    const int next = openat(folder, (*parts)[i].c_str(), O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    const int number = errno;
    struct stat facts {};
    const bool link =
        next < 0 && fstatat(folder, (*parts)[i].c_str(), &facts, AT_SYMLINK_NOFOLLOW) == 0 && S_ISLNK(facts.st_mode);
    close(folder);
    if (next < 0) return fault(link ? ELOOP : number, relative);
    folder = next;
  }
  if (folder < 0) return fault(errno, relative);
  const int descriptor = openat(folder, parts->back().c_str(), kFileFlags | O_NOFOLLOW);
  const int number = errno;
  close(folder);
  if (descriptor < 0) return fault(number, relative);
  return adopt(descriptor, relative, maxBytes);
}

}  // namespace limn
