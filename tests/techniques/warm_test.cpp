// No pipeline is compiled after the first frame, not even by a driver that compiles at the first dispatch: no turn of
// the loop takes a share of what warming up took.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "tests/support/processor_time.hpp"
#include "tests/support/rich_scene.hpp"
#include "tests/support/session_fixture.hpp"

namespace limn::test {
namespace {

/// The driver keeps nothing on disk, so that every compilation costs its full time.
const bool kWithoutDriverCache = setenv("MESA_SHADER_CACHE_DISABLE", "true", 1) == 0;

/// The rich scene with a fan that makes it `triangles` in all, so that tables have lengths of every kind. Its needs are
/// the same for all.
Scene sceneOf(size_t triangles) {
  RichScene rich = richScene();
  SceneBuilder b;
  b.scene = std::move(rich.scene);
  for (const Mesh& mesh : b.scene.meshes)
    for (const Primitive& primitive : mesh.primitives) triangles -= primitive.indices.size() / 3;
  Primitive fan;
  fan.material = int32_t(rich.metal);
  fan.positions = {{0.5f, 0.3f, -0.5f}};
  for (size_t i = 0; i <= triangles; ++i) {
    const float angle = 6.0f * float(i) / float(triangles);
    fan.positions.push_back(fan.positions[0] + 0.2f * glm::vec3(std::cos(angle), std::sin(angle), 0.1f * angle));
    if (i == 0) continue;
    for (const size_t corner : {size_t(0), i, i + 1}) fan.indices.push_back(uint32_t(corner));
  }
  fan.normals.assign(fan.positions.size(), {0.0f, 0.0f, 1.0f});
  b.mesh(fan);
  return b.scene;
}

class Warm : public testing::Test {
 protected:
  Warm() {
    SessionConfig config = smallPicture();
    config.quantumSeconds = 1e-3;
    config.parameters = {{"maxSamples", 32.0}};
    const double begin = processorSeconds();
    m_session = std::make_unique<TestSession>(sceneOf(1000), config);
    m_warmUp = processorSeconds() - begin;
    m_session->watch(true);
    EXPECT_TRUE(m_session->untilWarm());
  }
  TestSession& session() { return *m_session; }

  void expectNoCompilation(const std::string& after) {
    double slowest = 0.0;
    for (bool more = true; more;) {
      const double begin = processorSeconds();
      more = session().step();
      slowest = std::max(slowest, processorSeconds() - begin);
    }
    EXPECT_LT(slowest, m_warmUp / 12) << after << "; warming up took " << m_warmUp << " s";
  }

 private:
  std::unique_ptr<TestSession> m_session;
  double m_warmUp = 0.0;
};

TEST_F(Warm, TheFirstDispatchTakesNoLongerThanTheOthers) {
  ASSERT_TRUE(kWithoutDriverCache);
  expectNoCompilation("at first");
  session().edit({Edit(SetImageSize{96, 64})});
  expectNoCompilation("after a new size");
  SetNodeTransform move;
  move.node = richScene().metalNode;
  for (const double x : {0.1, 0.5, 2.0}) {
    move.translation = glm::dvec3(x, 0.2, 0.1);
    session().edit({move});
    expectNoCompilation("after a node moved to " + std::to_string(x));
  }
  PickRequest pick;
  pick.x = pick.y = 8;
  session().ask(pick);
  expectNoCompilation("after a pick");
}

TEST_F(Warm, TablesOfOtherLengthsCompileNothing) {
  expectNoCompilation("at first");
  // 4 or 16 bytes for each: powers of two, and lengths whose second byte is zero.
  for (const size_t triangles : {999, 1024, 2048, 4096, 12288, 16384, 16385}) {
    LoadRequest request;
    request.loaded = std::make_shared<LoadedScene>(LoadedScene{sceneOf(triangles), {}});
    session().ask(std::move(request));
    expectNoCompilation("after " + std::to_string(triangles) + " triangles were loaded");
  }
}

}  // namespace
}  // namespace limn::test
