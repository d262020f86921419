#pragma once
#include <cstdint>
#include <span>

#include "renderer/base/result.hpp"

namespace limn::bench {

/// Whether a PNG or JPEG picture is more than black and what compression makes of black. Errors: those of
/// readImageHeader() and decodeImage().
Result<bool> holdsLight(std::span<const uint8_t> picture);

}  // namespace limn::bench
