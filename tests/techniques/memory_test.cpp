// What memory is predicted before a scene is loaded onto the device, beside what the device's own account says then.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "renderer/scene/gltf_loader.hpp"
#include "renderer/session/session_memory.hpp"
#include "renderer/techniques/technique_info.hpp"
#include "tests/support/rich_scene.hpp"
#include "tests/support/session_fixture.hpp"

namespace limn::test {
namespace {

constexpr double kShare = 0.15;
/// An owner's buffers are each rounded up, by under a kilobyte.
constexpr double kRounding = 4096.0;
constexpr const char* kScenes[] = {"cornell-box", "cornell-glossy", "demo",      "textures",       "plant",
                                   "many-lights", "colonnade",      "veach-mis", "thin-furniture", "hard-degenerate"};

using Account = std::vector<std::pair<std::string, uint64_t>>;

void expectNear(uint64_t predicted, uint64_t measured, const std::string& owner) {
  EXPECT_LE(std::abs(double(predicted) - double(measured)), kShare * double(measured) + kRounding)
      << owner << ": predicted " << predicted << ", measured " << measured;
}

/// Owner by owner, and in all.
void expectPredicted(const vk::MemoryUse& predicted, const Account& account) {
  std::set<std::string> owners;
  uint64_t total = 0;
  for (const auto& [owner, bytes] : account) {
    owners.insert(owner);
    total += bytes;
    expectNear(predicted.ofOwner(owner), bytes, owner);
  }
  for (const auto& [owner, bytes] : predicted.byOwner()) EXPECT_TRUE(owners.contains(owner)) << owner;
  expectNear(predicted.totalBytes(), total, "all");
}

void expectPredicted(TestSession& session, const SessionConfig& config) {
  const gpu::MemoryPrediction predicted = predictMemory(session.scene(), config);
  const Status status = session.status();
  expectPredicted(predicted.device, status.memory);
  expectPredicted(predicted.host, status.hostMemory);
}

class Memory : public testing::TestWithParam<std::string> {
 protected:
  static SessionConfig config(bool allNeeds) {
    SessionConfig config = smallPicture(160, 96);
    config.technique = GetParam();
    config.allNeeds = allNeeds;
    for (const ParameterInfo& p : findTechnique(GetParam())->parameters)
      if (p.name == "points") config.parameters.push_back({p.name, 40000.0});
    return config;
  }
};

TEST_P(Memory, IsPredictedForEveryGeneratedScene) {
  const SessionConfig everything = config(true);  // one set of pipelines serves all scenes
  TestSession session(plainScene(), everything);
  expectPredicted(session, everything);
  for (const std::string name : kScenes) {
    SCOPED_TRACE(name);
    LoadRequest request;
    request.loaded = std::make_shared<LoadedScene>(must(loadGltf(LIMN_BUILD_DIR "/scenes/" + name + ".glb")));
    session.ask(std::move(request));
    session.run(0);
    ASSERT_EQ(session.take<LoadReply>().size(), 1u);
    expectPredicted(session, everything);
  }
}

TEST_P(Memory, OfWhatASceneDoesNotNeedThereIsNone) {
  const SessionConfig needed = config(false);
  TestSession session(plainScene(), needed);
  expectPredicted(session, needed);
  session.apply({SetImageSize{64, 200}});
  SessionConfig resized = needed;
  resized.width = 64;
  resized.height = 200;
  expectPredicted(session, resized);
}

std::vector<std::string> techniqueNames() {
  std::vector<std::string> names;
  for (const TechniqueInfo& info : techniqueInfos()) names.push_back(info.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, Memory, testing::ValuesIn(techniqueNames()), [](const auto& parameter) {
  std::string name = parameter.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace limn::test
