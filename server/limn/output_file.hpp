#pragma once
#include <filesystem>

#include "renderer/base/result.hpp"

namespace limn {

/// Whether writeFileAtomically() will be able to write there, before the work that the file is to hold: a file of the
/// name that it uses is made beside it and removed. Errors: "io", with the directory or file as their place.
Result<void> checkWritable(const std::filesystem::path& file);

}  // namespace limn
