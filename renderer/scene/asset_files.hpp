#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "renderer/base/result.hpp"

namespace limn {

/// An open regular file. Movable; closes itself.
class FileReader {
 public:
  explicit FileReader(int descriptor, uint64_t size) : m_descriptor(descriptor), m_size(size) {}
  FileReader(FileReader&& other) noexcept : m_descriptor(other.m_descriptor), m_size(other.m_size) {
    other.m_descriptor = -1;
  }
  FileReader& operator=(FileReader&&) = delete;
  ~FileReader();

  uint64_t size() const { return m_size; }  ///< [byte] when it was opened
  /// Exactly `count` bytes from `offset`; io when the file is shorter.
  Result<std::vector<uint8_t>> read(uint64_t offset, uint64_t count) const;

 private:
  int m_descriptor;
  uint64_t m_size;
};

/// The folder that a scene's files may come from. Nothing outside it is opened, through "..", links or otherwise. Any
/// thread.
class AssetRoot {
 public:
  /// `folder` itself may be reached through links. Errors: io.
  static Result<AssetRoot> open(const std::filesystem::path& folder);
  AssetRoot(AssetRoot&& other) noexcept : m_descriptor(other.m_descriptor), m_folder(std::move(other.m_folder)) {
    other.m_descriptor = -1;
  }
  AssetRoot& operator=(AssetRoot&&) = delete;
  ~AssetRoot();

  const std::filesystem::path& folder() const { return m_folder; }  ///< canonical
  /// Opens a regular file of at most `maxBytes`. `relative` is a path below the root. Links in it are not followed.
  /// Errors: path (leaves the root, is a link, is not a regular file), io (not there, not readable), limit (too large).
  Result<FileReader> openFile(const std::string& relative, uint64_t maxBytes) const;
  /// As openFile, by looking at each component by itself: for kernels without openat2.
  Result<FileReader> openFileByComponents(const std::string& relative, uint64_t maxBytes) const;

 private:
  AssetRoot(int descriptor, std::filesystem::path folder) : m_descriptor(descriptor), m_folder(std::move(folder)) {}

  int m_descriptor;
  std::filesystem::path m_folder;
};

}  // namespace limn
