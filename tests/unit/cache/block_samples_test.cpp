// Points that ride on blocks that are bent, stretched and scaled.
#include "renderer/cache/block_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/scene_builder.hpp"

namespace limn::test {
namespace {

constexpr uint32_t kCount = 4000, kSeed = 3;

/// A sheet of 2 m by 1 m in squares, hung along x.
Primitive sheet() {
  constexpr uint32_t kColumns = 32, kRows = 16;
  Primitive p;
  for (uint32_t y = 0; y <= kRows; ++y)
    for (uint32_t x = 0; x <= kColumns; ++x)
      p.positions.push_back({2.0f * float(x) / kColumns, float(y) / kRows, 0.0f});
  p.normals.assign(p.positions.size(), {0, 0, 1});
  for (uint32_t y = 0; y < kRows; ++y)
    for (uint32_t x = 0; x < kColumns; ++x) {
      const uint32_t a = y * (kColumns + 1) + x, b = a + 1, d = a + kColumns + 1, c = d + 1;
      p.indices.insert(p.indices.end(), {a, b, c, a, c, d});
    }
  return p;
}

/// The sheet at rest, posed by `pose` as morph targets and skins pose vertices.
template <class Pose>
Primitive posed(const Pose& pose) {
  Primitive p = sheet();
  p.restPositions = p.positions;
  for (glm::vec3& v : p.positions) v = pose(v);
  return p;
}

/// Round a cylinder, of `angle` [rad] from one end to the other: areas stay as they are.
Primitive rolled(float angle) {
  return posed([angle](const glm::vec3& v) {
    const float radius = 2.0f / angle, turn = v.x / radius;
    return glm::vec3(radius * std::sin(turn), v.y, radius * (1.0f - std::cos(turn)));
  });
}

/// The far half is `factor` times as long as at rest.
Primitive pulled(float factor) {
  return posed([factor](const glm::vec3& v) {
    return glm::vec3(v.x < 1.0f ? v.x : 1.0f + (v.x - 1.0f) * factor, v.y, 0.0f);
  });
}

/// A scene of one primitive on one node, sampled again after every change.
class Blocks {
 public:
  explicit Blocks(const Primitive& primitive) {
    m_builder.mesh(primitive);
    update();
  }
  /// Gives how many blocks were sampled.
  uint32_t pose(const Primitive& primitive) {
    m_builder.scene.meshes[0].primitives[0] = primitive;
    return update();
  }
  uint32_t scale(const glm::dvec3& scale) {
    m_builder.scene.nodes[0].parentFromLocal.scale = scale;
    return update();
  }
  const std::vector<BlockSite>& sites() const { return m_sampling.blocks()[0].sites; }
  double relativeRadius() const { return m_sampling.blocks()[0].relativeRadius; }
  /// Corners as they stand in the world.
  std::vector<glm::vec3> corners() const {
    gpu::GeometryBlock block = gpu::listBlocks(m_builder.scene)[0];
    gpu::placeBlock(m_builder.scene, m_builder.scene.worldFromNodes()[0], glm::dvec3(0.0), block);
    return block.corners;
  }

 private:
  uint32_t update() {
    const std::vector<gpu::GeometryBlock> blocks = gpu::listBlocks(m_builder.scene);
    const std::vector<glm::dmat4> worlds = m_builder.scene.worldFromNodes();
    const uint32_t sampled = m_sampling.update(m_builder.scene, blocks, worlds, kCount, kSeed);
    BlockSampling fresh;
    fresh.update(m_builder.scene, blocks, worlds, kCount, kSeed);
    EXPECT_EQ(fresh.blocks()[0].sites, sites()) << "another history, other points";
    return sampled;
  }

  SceneBuilder m_builder;
  BlockSampling m_sampling;
};

TEST(BlockSampling, PointsRideOnBentSurfaces) {
  Blocks blocks(sheet());
  const std::vector<BlockSite> atRest = blocks.sites();
  for (const float angle : {0.1f, 0.5f, 1.0f, 2.0f, 3.0f}) {
    EXPECT_EQ(blocks.pose(rolled(angle)), 0u) << angle;
    EXPECT_EQ(blocks.sites(), atRest);
    // A roll keeps all lengths on the surface, so points are as far apart as before, but for the curve between them.
    EXPECT_GE(relativeRadius(blocks.corners(), std::span(blocks.sites()).first(kCount)), 0.6) << angle;
  }
}

TEST(BlockSampling, OnlyPosesOfOtherAreasAreSampledAnew) {
  Blocks blocks(sheet());
  const std::vector<BlockSite> atRest = blocks.sites();
  for (const float factor : {1.1f, 1.3f, 1.6f, 0.8f}) EXPECT_EQ(blocks.pose(pulled(factor)), 0u) << factor;
  EXPECT_EQ(blocks.sites(), atRest);
  EXPECT_EQ(blocks.pose(pulled(2.0f)), 1u);  // a sixth of the points would be misplaced
  EXPECT_NE(blocks.sites(), atRest);
  EXPECT_GE(relativeRadius(blocks.corners(), std::span(blocks.sites()).first(kCount)), 0.6);
  EXPECT_EQ(blocks.pose(pulled(1.3f)), 1u);
  EXPECT_EQ(blocks.sites(), atRest);
}

TEST(BlockSampling, ABlockOfAnySizeHasTheSamePoints) {
  Blocks blocks(sheet());
  const std::vector<BlockSite> before = blocks.sites();
  for (const double scale : {1.02, 1.3, 7.0, 1e-3}) EXPECT_EQ(blocks.scale(glm::dvec3(scale)), 0u) << scale;
  for (const double scale : {1.05, 0.95}) EXPECT_EQ(blocks.scale({1.0, scale, 1.0}), 0u) << scale;
  EXPECT_EQ(blocks.sites(), before);
  EXPECT_EQ(blocks.scale({1.0, 1.5, 1.0}), 1u);
  EXPECT_NE(blocks.sites(), before);
  EXPECT_GE(relativeRadius(blocks.corners(), std::span(blocks.sites()).first(kCount)), 0.6);
}

/// Between two steps of the shape, points are at most a tenth nearer to each other along one axis.
TEST(BlockSampling, StretchesWithinAStepCostLittleEvenness) {
  Blocks blocks(sheet());
  for (double scale = 1.0; scale < 2.0; scale *= 1.03) {
    blocks.scale({1.0, scale, 1.0});
    const double placed = relativeRadius(blocks.corners(), std::span(blocks.sites()).first(kCount));
    EXPECT_GE(placed, 0.85 * blocks.relativeRadius()) << scale;
    EXPECT_GE(placed, 0.55) << scale;
  }
}

TEST(BlockSampling, ARestPoseWithoutAreaIsNotSampled) {
  Primitive grown = sheet();
  grown.restPositions.assign(grown.positions.size(), glm::vec3(1.0f));
  Blocks blocks(sheet());
  const std::vector<BlockSite> before = blocks.sites();
  blocks.pose(grown);
  EXPECT_EQ(blocks.sites(), before);  // the same triangles, the same points
}

}  // namespace
}  // namespace limn::test
