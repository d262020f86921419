#include "renderer/placement/adaptive_grid.hpp"

#include <algorithm>
#include <bit>

#include "renderer/gpu/work_groups.hpp"
#include "shaders/shared/bindings.h"

namespace limn {
namespace {

uint32_t groupsOf(uint32_t candidates) { return (candidates + shared::kPlacementGroup - 1) / shared::kPlacementGroup; }

void recordStage(const gpu::Pass& pass, vk::CommandRecorder& recorder, const std::vector<vk::Binding>& bindings,
                 const shared::SelectSitesPush& push) {
  const gpu::WorkGroups groups = gpu::groupsInRows(push.stage == 1 ? 1 : groupsOf(push.candidates));
  pass.record(recorder, bindings, push, groups.x, groups.y);
}

}  // namespace

Result<void> AdaptiveGrid::prepare(vk::Device& device, const PlacementBuffers& buffers, uint32_t width,
                                   uint32_t height) {
  if (!m_selection || m_width != width || m_height != height) {
    vk::BufferDesc desc;
    desc.owner = "placement";
    desc.name = "placement.selection";
    desc.size = (2 * size_t(groupsOf(scatteredCount(width, height))) + 2) * sizeof(uint32_t);
    desc.memory = vk::MemoryKind::readback;
    auto made = vk::Buffer::create(device, desc);
    if (!made) return made.error();
    m_selection = made.take();
    m_width = width;
    m_height = height;
  }
  if (m_pass) return {};
  const auto like = bindings(buffers);
  auto pass = gpu::Pass::create(device, "select_sites", like, sizeof(shared::SelectSitesPush));
  if (!pass) return pass.error();
  m_pass = pass.take();
  return gpu::runNow(device, [&](vk::CommandRecorder& r) { m_pass.warmUp(r, like); });
}

std::vector<vk::Binding> AdaptiveGrid::bindings(const PlacementBuffers& buffers) const {
  return {vk::storage(BINDING_G_BUFFER, buffers.sites), vk::storage(BINDING_INDIRECT, buffers.gathered),
          vk::storage(BINDING_PIXEL_LIST, buffers.list), vk::storage(BINDING_SELECTION, m_selection)};
}

uint32_t AdaptiveGrid::gridCount(uint32_t stride) const {
  return ((m_width + stride - 1) / stride) * ((m_height + stride - 1) / stride);
}

// A square of a power of two about the picture.
uint32_t AdaptiveGrid::scatteredCount(uint32_t width, uint32_t height) {
  const uint32_t bits = std::max<uint32_t>(1, uint32_t(std::bit_width(std::max(width, height) - 1)));
  return 1u << (2 * bits);
}

Result<uint32_t> AdaptiveGrid::select(vk::Device& device, const PlacementBuffers& buffers,
                                      shared::SelectSitesPush push) const {
  push.width = m_width;
  push.height = m_height;
  const auto all = bindings(buffers);
  auto done = gpu::runNow(device, [&](vk::CommandRecorder& r) {
    for (push.stage = 0; push.stage < 3; ++push.stage) {
      recordStage(m_pass, r, all, push);
      r.barrier();
    }
  });
  if (!done) return done.error();
  return m_selection.as<uint32_t>()[groupsOf(push.candidates)];
}

Result<uint32_t> AdaptiveGrid::selectGrid(vk::Device& device, const PlacementBuffers& buffers, uint32_t stride) const {
  shared::SelectSitesPush push{};
  push.rule = shared::kSelectGrid;
  push.stride = stride;
  push.candidates = gridCount(stride);
  return select(device, buffers, push);
}

Result<uint32_t> AdaptiveGrid::selectIncoherent(vk::Device& device, const PlacementBuffers& buffers, uint32_t stride,
                                                const CoherenceRule& rule) const {
  shared::SelectSitesPush push{};
  push.rule = shared::kSelectIncoherent;
  push.stride = stride;
  push.candidates = gridCount(stride);
  push.threshold = rule.threshold;
  push.lambda = rule.lambda;
  push.inverseExtent = rule.extent > 0.0f ? 1.0f / rule.extent : 0.0f;
  push.inverseLuminance = rule.luminance > 0.0f ? 1.0f / rule.luminance : 0.0f;
  return select(device, buffers, push);
}

Result<uint32_t> AdaptiveGrid::selectScattered(vk::Device& device, const PlacementBuffers& buffers, uint32_t first,
                                               uint32_t count, bool unsampledOnly) const {
  shared::SelectSitesPush push{};
  push.rule = unsampledOnly ? shared::kSelectUnsampled : shared::kSelectScattered;
  push.stride = 1;
  push.first = first;
  push.candidates = std::min(count, scatteredCount() - std::min(first, scatteredCount()));
  if (push.candidates == 0) return 0u;
  return select(device, buffers, push);
}

Result<double> AdaptiveGrid::meanLuminance(vk::Device& device, const PlacementBuffers& buffers, uint32_t stride) const {
  shared::SelectSitesPush push{};
  push.width = m_width;
  push.height = m_height;
  push.stage = 3;
  push.stride = stride;
  push.candidates = gridCount(stride);
  const auto all = bindings(buffers);
  auto done = gpu::runNow(device, [&](vk::CommandRecorder& r) { recordStage(m_pass, r, all, push); });
  if (!done) return done.error();
  const auto words = m_selection.as<uint32_t>();
  double sum = 0.0, number = 0.0;
  for (uint32_t i = 0; i < groupsOf(push.candidates); ++i) {
    sum += std::bit_cast<float>(words[2 * i]);
    number += words[2 * i + 1];
  }
  return number > 0.0 ? sum / number : 0.0;
}

}  // namespace limn
