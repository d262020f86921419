#pragma once
#include <string>
#include <vector>

#include "tests/service/child_process.hpp"
#include "tests/service/service_fixture.hpp"

namespace limn::server::testing {

inline const std::string kProgram = LIMN_BUILD_DIR "/bin/limnd";
inline const std::string kScenes = LIMN_BUILD_DIR "/scenes";
inline const std::string kScene = kScenes + "/cornell-box.glb";

/// A daemon on a small scene that is ready to take clients. `more` goes behind its flags.
class Daemon {
 public:
  explicit Daemon(std::vector<std::string> more = {}) : Daemon(defaults(), std::move(more)) {}
  /// `flags` instead of those that are usual in tests.
  Daemon(std::vector<std::string> flags, std::vector<std::string> more) : process(kProgram, joined(flags, more)) {
    const std::string begin = "listening on http://127.0.0.1:";
    line = process.readLine();
    EXPECT_TRUE(line.starts_with(begin)) << line;
    if (line.starts_with(begin)) port = uint16_t(std::stoi(line.substr(begin.size())));
  }
  static std::vector<std::string> defaults() {
    return {"--scene", kScene, "--listen", "127.0.0.1:0", "--size", "64x64", "--state-dir",
            LIMN_BUILD_DIR "/tests/state"};
  }

  ChildProcess process;
  std::string line;     ///< what it printed when it was ready
  uint16_t port = 0;

 private:
  static std::vector<std::string> joined(std::vector<std::string> flags, const std::vector<std::string>& more) {
    flags.insert(flags.end(), more.begin(), more.end());
    return flags;
  }
};

/// A film that is done soon.
inline void endAfter(TestClient& client, double samples) {
  protocol::TechniqueEdit edit;
  edit.parameters = {{"maxSamples", samples}};
  const uint32_t seq = client.nextSeq();
  client.send(protocol::SetMessage{seq, edit});
  client.awaitReply<protocol::Ack>(seq);
}

inline uint64_t convergedHash(TestClient& client) {
  const uint32_t seq = client.nextSeq();
  client.send(protocol::Wait{seq, std::nullopt, std::nullopt});
  return client.awaitReply<protocol::Waited>(seq).filmHash.value;
}

/// The pixels of the last picture that shows `edit`, once the film has converged.
inline std::vector<uint8_t> pictureAtRest(TestClient& client, uint32_t edit) {
  const auto last =
      client.awaitPicture([&](const auto& h) { return (h.flags & protocol::kFrameFinal) && h.ackSeq >= edit; });
  uint32_t width = 0, height = 0;
  return decodeImage(last.payload, last.header.encoding, width, height);
}

}  // namespace limn::server::testing
