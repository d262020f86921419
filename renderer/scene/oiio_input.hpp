#pragma once
#include <memory>
#include <string>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "renderer/base/result.hpp"

namespace limn {

/// Opens memory with the one reader of that name ("png", "jpeg", "hdr", "openexr"); no other reader is tried and no
/// plugin is looked for on disk. `memory` must outlive the input. Errors: bad-file.
Result<std::unique_ptr<OIIO::ImageInput>> openOiio(const char* reader, OIIO::Filesystem::IOProxy& memory);

/// The reader's last complaint, one line.
std::string oiioMessage(OIIO::ImageInput& input);

}  // namespace limn
