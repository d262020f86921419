#include "renderer/gather/point_projection.hpp"

#include <algorithm>

#include "renderer/base/check.hpp"
#include "renderer/gpu/work_groups.hpp"

namespace limn {
namespace {

// constant_id of kUseSharp and of the first of a gather's own
constexpr size_t kSharpConstant = 12, kGatherConstants = 16;

/// Mirrors are none of a gather's business: that need says here whether points have lobes, so that the general variant,
/// which has all needs, has them too.
SceneNeeds needsOfGather(SceneNeeds needs, bool lobes) {
  needs.mirror = lobes;
  return needs;
}

std::vector<uint32_t> tailoredConstants(const SceneNeeds& needs) { return gatherConstants(needs, needs.mirror); }

void recordWith(const gpu::TailoredPass& pass, vk::CommandRecorder& recorder, const std::vector<vk::Binding>& bindings,
                shared::PointProjectionPush push) {
  LIMN_CHECK(push.clusterCount > 0 && push.clusterCount <= kMostGatherClusters);
  LIMN_CHECK(push.clusterUsed > 0 && push.clusterUsed <= push.clusterSize);
  LIMN_CHECK(push.microSize > 0 && push.microSize <= kMostMicroSize);
  if (push.entryCount == 0) return;
  push.projections = std::clamp(push.projections, 2 * push.clusterCount, kMostProjections);
  const gpu::WorkGroups groups = gpu::groupsInRows(push.entryCount);  // one a site
  pass->record(recorder, bindings, push, groups.x, groups.y);
}

}  // namespace

std::vector<uint32_t> gatherConstants(const SceneNeeds& needs, bool lobes, const GatherVariant& variant) {
  std::vector<uint32_t> words = gpu::needsConstants(needs);
  LIMN_CHECK_LE(words.size(), kSharpConstant);
  words.resize(kGatherConstants);
  words[3] = needs.glossy;  // the rough lobes alone are gathered
  words[kSharpConstant] = needs.sharp;
  words.insert(words.end(), {lobes, variant.workgroup, variant.selection, variant.splatSide});
  return words;
}

PointProjection::PointProjection()
    : m_pixels("gather_pixels_corrected", sizeof(shared::PointProjectionPush), &tailoredConstants),
      m_points("gather_points_corrected", sizeof(shared::PointProjectionPush), &tailoredConstants) {}

Result<void> PointProjection::prepare(vk::Device& device, const std::vector<vk::Binding>& atPixels,
                                      const std::vector<vk::Binding>& atPoints, const SceneNeeds& needs, bool lobes,
                                      bool mayCompile) {
  const SceneNeeds gatherNeeds = needsOfGather(needs, lobes);
  if (auto done = m_pixels.prepare(device, atPixels, gatherNeeds, mayCompile); !done) return done;
  return m_points.prepare(device, atPoints, gatherNeeds, mayCompile);
}

void PointProjection::recordAtPixels(vk::CommandRecorder& recorder, const std::vector<vk::Binding>& bindings,
                                     const shared::PointProjectionPush& push) const {
  recordWith(m_pixels, recorder, bindings, push);
}

void PointProjection::recordAtPoints(vk::CommandRecorder& recorder, const std::vector<vk::Binding>& bindings,
                                     const shared::PointProjectionPush& push) const {
  recordWith(m_points, recorder, bindings, push);
}

}  // namespace limn
