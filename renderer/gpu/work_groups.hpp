#pragma once
#include <algorithm>
#include <cstdint>

namespace limn::gpu {

/// Workgroups of a dispatch in x and y.
struct WorkGroups {
  uint32_t x, y;
};

/// At least `count` workgroups in rows, both numbers within every device's limit of 65,535. Shaders number a workgroup
/// gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; those past the end do nothing.
inline WorkGroups groupsInRows(uint32_t count) {
  constexpr uint32_t kRow = 4096;
  return {std::min(count, kRow), (count + kRow - 1) / kRow};
}

}  // namespace limn::gpu
