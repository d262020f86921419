#include <bit>

#include "shaders/shared/film_shared.h"
#include "shaders/shared/g_buffer_shared.h"
#include "shaders/shared/scene_shared.h"
#include "tests/gpu/kernel.hpp"
#include "tests/gpu/shared_structs.spv.hpp"

namespace limn::test {
namespace {

/// As the buffer of shaders/shared_structs.comp. The BVH's node is no struct there: bvh_test.cpp holds its words.
struct Structs {
  shared::TextureSlot textureSlot[2];
  shared::ImageInfo imageInfo[2];
  shared::MaterialData materialData[2];
  shared::LightData lightData[2];
  shared::LightNode lightNode[2];
  shared::SceneInfo sceneInfo[2];
  shared::CameraData cameraData[2];
  shared::PathTracingPush pathTracingPush[2];
  shared::ResolvePush resolvePush[2];
  shared::AuditRecord auditRecord[2];
  shared::AuditPush auditPush[2];
  shared::TileError tileError[2];
  shared::FilmErrorPush filmErrorPush[2];
  shared::SelectPush selectPush[2];
  shared::GBufferTexel gBufferTexel[2];
  shared::GBufferPush gBufferPush[2];
};

/// Gives every field a value of its own and remembers its words.
class Filler {
 public:
  template <class... Fields>
  void operator()(size_t structBytes, Fields&... fields) {
    const size_t before = m_words.size();
    (put(fields), ...);
    EXPECT_EQ((m_words.size() - before) * 4, structBytes) << "a field was left out before word " << m_words.size();
  }
  const std::vector<uint32_t>& words() const { return m_words; }

 private:
  void put(uint32_t& v) { m_words.push_back(v = 0x1000u + uint32_t(m_words.size())); }
  void put(float& v) { m_words.push_back(std::bit_cast<uint32_t>(v = 0.5f + float(m_words.size()))); }
  template <int N>
  void put(glm::vec<N, float>& v) {
    for (int i = 0; i < N; ++i) put(v[i]);
  }
  std::vector<uint32_t> m_words;
};

void fillScene(Filler& fill, Structs& s) {
  auto& t = s.textureSlot[1];
  fill(sizeof t, t.image, t.sampler_, t.rowU, t.rowV, t.target, t.scale);
  auto& i = s.imageInfo[1];
  fill(sizeof i, i.firstTexel, i.width, i.height, i.pad);
  auto& m = s.materialData[1];
  fill(sizeof m, m.baseColor, m.emission, m.metallic, m.roughness, m.ior, m.transmission, m.specular, m.specularColor,
       m.clearcoat, m.clearcoatRoughness, m.alphaCutoff, m.absorption, m.flags, m.firstSlot, m.slotCount);
  auto& l = s.lightData[1];
  fill(sizeof l, l.posR, l.type, l.dirR, l.triangle, l.color, l.invRange, l.spotScale, l.spotOffset, l.area,
       l.probability, l.aliasShare, l.alias, l.node);
  auto& b = s.lightNode[1];
  fill(sizeof b, b.centerR, b.radius, b.axis, b.cosOpening, b.intensity, b.cosEnd, b.child, b.parent);
  auto& n = s.sceneInfo[1];
  fill(sizeof n, n.lightCount, n.environmentLight, n.environmentWidth, n.environmentHeight, n.environmentRadiance,
       n.environmentRotation, n.distributionWidth, n.distributionHeight, n.sceneRadius, n.triangleCount, n.lightTreeShare);
  auto& c = s.cameraData[1];
  fill(sizeof c, c.eyeR, c.clipNear, c.right, c.perspective, c.up, c.width, c.forward, c.height);
}

void fillFilm(Filler& fill, Structs& s) {
  auto& p = s.pathTracingPush[1];
  fill(sizeof p, p.firstEntry, p.entryCount, p.firstSample, p.sampleCount, p.seed, p.maxBounces, p.rouletteStart,
       p.byEntry);
  auto& r = s.resolvePush[1];
  fill(sizeof r, r.width, r.height, r.stride, r.toneMap, r.exposure, r.view);
  auto& a = s.auditRecord[1];
  fill(sizeof a, a.shown, a.shownCount, a.even, a.evenCount, a.odd, a.oddCount, a.squares);
  fill(sizeof s.auditPush[1], s.auditPush[1].entryCount);
  auto& e = s.tileError[1];
  fill(sizeof e, e.radianceSum, e.samples, e.errorSum, e.squareSum);
  auto& f = s.filmErrorPush[1];
  fill(sizeof f, f.width, f.height, f.stage, f.largestBin, f.meanRadiance);
  auto& q = s.selectPush[1];
  fill(sizeof q, q.width, q.height, q.minSamples, q.tileCount, q.threshold, q.stage, q.meanLuminance);
  auto& g = s.gBufferTexel[1];
  fill(sizeof g, g.triangle, g.barycentrics, g.distance, g.posR, g.pad);
  auto& b = s.gBufferPush[1];
  fill(sizeof b, b.x, b.y, b.width, b.height);
}

TEST(SharedStructs, ShadersReadEveryFieldThatTheHostWrites) {
  std::vector<Structs> structs(1);
  Filler fill;
  fillScene(fill, structs[0]);
  fillFilm(fill, structs[0]);
  const vk::Buffer in = inputOf(structs);
  const uint32_t count = uint32_t(fill.words().size());
  EXPECT_EQ(runKernel<uint32_t>(shared_structsSpirv, {vk::storage(0, in)}, count, count, 1), fill.words());
}

}  // namespace
}  // namespace limn::test
