#include "renderer/reconstruct/joint_bilateral.hpp"

#include "shaders/shared/bindings.h"

namespace limn {
namespace {

constexpr uint32_t kGroupWidth = 16, kGroupHeight = 4;  // of the shaders

uint32_t groups(uint32_t items, uint32_t size) { return (items + size - 1) / size; }

std::vector<vk::Binding> interpolateBindings(const ReconstructBuffers& b) {
  return {vk::storage(BINDING_G_BUFFER, b.sites), vk::storage(BINDING_INDIRECT, b.gathered)};
}
std::vector<vk::Binding> filterBindings(const ReconstructBuffers& b) {
  return gpu::joined(interpolateBindings(b), {vk::storage(BINDING_INDIRECT_OUT, b.filtered)});
}

}  // namespace

Result<void> JointBilateral::prepare(vk::Device& device, const ReconstructBuffers& buffers, uint32_t width,
                                     uint32_t height) {
  m_width = width;
  m_height = height;
  if (!m_interpolate) {
    auto pass =
        gpu::Pass::createWarm(device, "interpolate", interpolateBindings(buffers), sizeof(shared::ReconstructPush));
    if (!pass) return pass.error();
    m_interpolate = pass.take();
  }
  if (!m_filter) {
    auto pass =
        gpu::Pass::createWarm(device, "filter_indirect", filterBindings(buffers), sizeof(shared::ReconstructPush));
    if (!pass) return pass.error();
    m_filter = pass.take();
  }
  return {};
}

void JointBilateral::recordInterpolate(vk::CommandRecorder& recorder, const ReconstructBuffers& buffers,
                                       uint32_t stride) const {
  const uint32_t columns = groups(m_width, stride), rows = gridRows(stride);
  const shared::ReconstructPush push{m_width, m_height, stride, 0, 0, rows};
  m_interpolate.record(recorder, interpolateBindings(buffers), push, groups(columns, kGroupWidth),
                       groups(rows, kGroupHeight));
  recorder.barrier();
}

void JointBilateral::recordFilter(vk::CommandRecorder& recorder, const ReconstructBuffers& buffers, uint32_t size,
                                  RowRange rows) const {
  const shared::ReconstructPush push{m_width, m_height, 1, (size - 1) / 2, rows.first, rows.count};
  m_filter.record(recorder, filterBindings(buffers), push, groups(m_width, kGroupWidth),
                  groups(rows.count, kGroupHeight));
}

}  // namespace limn
