#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "renderer/base/result.hpp"

namespace limn {

/// The name beside `file` that writeFileAtomically() of this process writes to first.
std::filesystem::path temporaryFor(const std::filesystem::path& file);

/// The file appears whole or not at all: written beside its final place, then renamed. Errors: "io". Any thread.
Result<void> writeFileAtomically(const std::filesystem::path& file, std::span<const uint8_t> bytes);

/// A regular file of at most `mostBytes`. Errors: "io" (absent, a directory, unreadable), "limit".
Result<std::vector<uint8_t>> readFileBytes(const std::filesystem::path& file, uint64_t mostBytes);

}  // namespace limn
