// Wrong messages and broken files: the daemon answers each with its error, and the scene renders on.
#include "protocol/json_value.hpp"
#include "tests/service/cli/run_program.hpp"
#include "tests/service/daemon_fixture.hpp"
#include "tests/service/wrong_messages.hpp"

namespace limn::server::testing {
namespace {

const std::string kCorpus = kScenes + "/malformed";

/// What the generator of the corpus says about a file.
struct BrokenFile {
  std::string file, code, place;
};

/// The wire does not tell broken JSON from other broken files. protocol/spec.md, error codes.
std::string wireCode(const std::string& code) { return code == "bad-json" ? "bad-file" : code; }

std::vector<BrokenFile> brokenFiles() {
  const Result<protocol::JsonValue> listing = protocol::parseJson(test::readText(kCorpus + "/expected.json"), 8);
  EXPECT_TRUE(listing.ok()) << "the target limn_scenes makes " << kCorpus;
  std::vector<BrokenFile> files;
  if (!listing) return files;
  for (const protocol::JsonValue& one : *listing->find("cases")->array()) {
    const std::string path = *one.find("file")->string(), pointer = *one.find("pointer")->string();
    const std::string name = path.substr(path.rfind('/') + 1);
    files.push_back({name, wireCode(*one.find("code")->string()), name + (pointer.empty() ? "" : "#" + pointer)});
  }
  return files;
}

/// Another scene and back: the film is rendered twice from its first sample. Returns both films' hashes.
std::pair<uint64_t, uint64_t> renderAnotherAndBack(TestClient& client, const protocol::SceneMessage& scene) {
  const auto converge = [&](const std::array<float, 4>& color) {
    protocol::MaterialEdit edit;
    edit.material = 0;
    edit.baseColor = color;
    const uint32_t seq = client.nextSeq();
    client.send(protocol::SetMessage{seq, edit});
    EXPECT_NE(client.awaitReply<protocol::Ack>(seq).cost, protocol::CostClass::none);
    return convergedHash(client);
  };
  const uint64_t another = converge({0.125f, 0.25f, 0.5f, 1.0f});
  return {another, converge(scene.materials.at(0).baseColor)};
}

/// The daemon renders the sound file of the corpus, whose folder is the asset root.
class LimndMalformed : public ::testing::Test {
 protected:
  LimndMalformed()
      : daemon({"--scene", kCorpus + "/files/control.glb", "--listen", "127.0.0.1:0", "--size", "32x32"}, {}),
        client(daemon.port) {
    client.greet();
    scene = client.await<protocol::SceneMessage>();
    endAfter(client, 4);
    before = convergedHash(client);
    client.send(protocol::Describe{client.nextSeq()});
    scene = client.await<protocol::SceneMessage>();
    picture = rest();
  }
  /// The scene is the one of the beginning, and so is every pixel that is rendered of it from now on.
  void expectTheSameScene() {
    client.send(protocol::Describe{client.nextSeq()});
    const auto after = client.await<protocol::SceneMessage>();
    EXPECT_EQ(after.hash, scene.hash);
    EXPECT_EQ(after.sceneRevision, scene.sceneRevision);
    EXPECT_EQ(convergedHash(client), before);
    const auto [another, again] = renderAnotherAndBack(client, scene);
    EXPECT_NE(another, before) << "the edit was not rendered";
    EXPECT_EQ(again, before);
    EXPECT_EQ(rest(), picture);
  }

  Daemon daemon;
  TestClient client;
  protocol::SceneMessage scene;
  uint64_t before = 0;
  std::vector<uint8_t> picture;

 private:
  std::vector<uint8_t> rest() {
    TestClient watcher(daemon.port);
    watcher.greet();
    return pictureAtRest(watcher, 0);
  }
};

TEST_F(LimndMalformed, eachMessageIsAnsweredWithItsErrorAndTheSceneRendersOn) {
  ASSERT_GE(wrongMessages().size(), 20u);
  TestClient wrong(daemon.port);
  wrong.greet(false);
  for (const WrongMessage& message : wrongMessages()) {
    wrong.sendWrong(message.text);
    const auto error = wrong.await<protocol::ErrorMessage>();
    EXPECT_EQ(error.code, message.code) << message.name << ": " << error.message;
    EXPECT_EQ(error.place.value_or(""), message.place) << message.name << ": " << error.message;
  }
  expectTheSameScene();
}

/// The renderer knows edits only; where a field stood in the message depends on the message.
TEST_F(LimndMalformed, theFieldOfACameraIsNamedAsInItsMessage) {
  const std::string nowhere = R"("eye":[1,0,0],"target":[1,0,0],"up":[0,1,0])";
  const std::vector<std::pair<std::string, std::string>> cases{
      {R"("op":"camera",)" + nowhere, "/target"},
      {R"("op":"set","target":"camera","view":{)" + nowhere + "}", "/view/target"},
      {R"("op":"batch","edits":[{"target":"resolve"},{"target":"camera","view":{)" + nowhere + "}}]", "/edits/1/view/target"}};
  for (const auto& [message, place] : cases) {
    const std::string seq = std::to_string(client.nextSeq());
    client.sendWrong("{" + message + R"(,"seq":)" + seq + "}");
    const auto error = client.await<protocol::ErrorMessage>();
    EXPECT_EQ(error.code, "out-of-range");
    EXPECT_EQ(error.place.value_or(""), "seq " + seq + " " + place);
  }
}

TEST_F(LimndMalformed, eachFileIsAnsweredWithItsErrorAndTheSceneRendersOn) {
  const std::vector<BrokenFile> files = brokenFiles();
  ASSERT_GE(files.size(), 20u);
  for (const BrokenFile& broken : files) {
    const uint32_t seq = client.nextSeq();
    client.send(protocol::Load{seq, broken.file});
    const auto error = client.await<protocol::ErrorMessage>();
    EXPECT_EQ(error.seq, seq) << broken.file;
    EXPECT_EQ(error.code, broken.code) << broken.file << ": " << error.message;
    EXPECT_EQ(error.place.value_or(""), broken.place) << error.message;
  }
  expectTheSameScene();
}

}  // namespace
}  // namespace limn::server::testing
