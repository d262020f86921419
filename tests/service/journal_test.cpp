// The file that accepted edits are kept in: what comes back of it, whatever happened to it.
#include "server/journal.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "renderer/base/clock.hpp"
#include "tests/service/cli/run_program.hpp"
#include "tests/service/service_fixture.hpp"

namespace limn::server::testing {
namespace {

namespace fs = std::filesystem;
using Messages = std::vector<protocol::ClientMessage>;

protocol::ClientMessage edited(protocol::Edit edit) { return protocol::Batch{1, {std::move(edit)}}; }

protocol::ClientMessage roughness(uint32_t material, float value) {
  protocol::MaterialEdit edit;
  edit.material = material;
  edit.roughness = value;
  return edited(edit);
}

protocol::ClientMessage view(double x) {
  protocol::CameraEdit edit;
  edit.view.eye = {x, 1.0, 2.0};
  edit.view.yfov = 0.5f;
  return edited(edit);
}

protocol::ClientMessage technique(std::optional<std::string> name, std::vector<std::pair<std::string, double>> parameters) {
  return edited(protocol::TechniqueEdit{std::move(name), std::move(parameters)});
}

std::unique_ptr<Journal> opened(const std::string& file) {
  Result<std::unique_ptr<Journal>> journal = Journal::open(file);
  EXPECT_TRUE(journal.ok()) << (journal ? "" : journal.error().text());
  return journal ? journal.take() : nullptr;
}

void append(Journal& journal, const Messages& messages) {
  const Result<void> done = journal.append(messages);
  EXPECT_TRUE(done.ok()) << (done ? "" : done.error().text());
}

/// What a journal has to say after these.
Messages summaryOf(const Messages& messages, size_t count) {
  EditSummary summary;
  for (size_t i = 0; i < count; ++i) summary.add(messages[i]);
  return summary.messages();
}

std::string bytesOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A bit of everything.
Messages someEdits() {
  protocol::MaterialEdit coat;
  coat.material = 2;
  coat.clearcoat = 0.1f;
  protocol::EnvironmentEdit sky;
  sky.image = "skies/evening.hdr";
  return {roughness(2, 0.25f), view(1.0), edited(coat), technique({}, {{"maxBounces", 3.0}}), roughness(2, 0.75f), edited(sky),
          technique("point-projection", {{"bounces", 2.0}}), protocol::Load{7, "rooms/käse.glb"}, roughness(1, 0.5f), view(4.0)};
}

TEST(EditSummary, keepsTheNewestOfEachThing) {
  const Messages edits = someEdits();
  protocol::MaterialEdit both;
  both.material = 2;
  both.clearcoat = 0.1f;
  both.roughness = 0.75f;
  const Messages before = summaryOf(edits, 6);
  ASSERT_EQ(before.size(), 4u) << "technique, view, environment and one material";
  EXPECT_NE(std::find(before.begin(), before.end(), edited(both)), before.end());
  const Messages after = summaryOf(edits, edits.size());
  ASSERT_EQ(after.size(), 5u);
  EXPECT_EQ(after[0], protocol::ClientMessage(protocol::Load{1, "rooms/käse.glb"}));
  EXPECT_EQ(after[2], edits[6]) << "another scene is shown by the same technique";
  EXPECT_EQ(Messages(after.begin() + 3, after.end()), (Messages{view(4.0), roughness(1, 0.5f)}))
      << "and has nothing else of the one before";
}

TEST(EditSummary, keepsEveryLensThatAFileMayHave) {
  for (const float yfov : {1e-4f, 3.1405926f, 3.1405928f})
    for (const float metres : {1e-45f, 1e-12f, 1e30f}) {
      protocol::CameraEdit edit;
      edit.view.up = {0.0, 1.0, 0.0};
      edit.view.yfov = yfov;
      edit.view.ymag = edit.view.znear = metres;
      const Messages edits{edited(edit)};
      EXPECT_EQ(summaryOf(edits, 1), edits) << yfov << " rad, " << metres << " m";
    }
}

TEST(EditSummary, passesOverWhatCannotBeSaid) {
  protocol::CameraEdit edit;
  edit.view.yfov = 4.0f;
  const Messages edits{edited(edit), roughness(1, 0.5f)};
  EXPECT_EQ(summaryOf(edits, 2), (Messages{edits[1]}));
}

TEST(EditSummary, aChangeOfTechniqueBeginsWithDefaults) {
  EditSummary summary;
  const Messages edits{technique({}, {{"maxBounces", 3.0}}), technique("point-projection", {{"bounces", 2.0}}),
                       technique({}, {{"points", 65536.0}}), technique("path-tracing", {})};
  for (size_t i = 0; i < 3; ++i) summary.add(edits[i]);
  EXPECT_EQ(summary.messages(), (Messages{edits[0], technique("point-projection", {{"bounces", 2.0}, {"points", 65536.0}})}));
  summary.add(edits[3]);
  EXPECT_EQ(summary.messages(), (Messages{edits[3]})) << "nothing is left of the technique before";
}

TEST(EditSummary, forgetsWhatIsRefusedAndNoMore) {
  EditSummary summary;
  protocol::MaterialEdit material;
  material.material = 2;
  material.roughness = material.metallic = 0.5f;
  protocol::CameraEdit camera;
  camera.view.up = {0.0, 1.0, 0.0};
  const protocol::TechniqueEdit chosen{"path-tracing", {{{"gone", 1.0}, {"bounces", 2.0}}}};
  for (const protocol::Edit& edit : {protocol::Edit(material), protocol::Edit(camera), protocol::Edit(chosen), protocol::Edit(protocol::ImageEdit{640, 480})})
    summary.add(edited(edit));
  EXPECT_TRUE(summary.forget(chosen, "/parameters/gone"));
  EXPECT_TRUE(summary.forget(material, "/roughness"));
  EXPECT_TRUE(summary.forget(camera, "/view/target")) << "half a view is none";
  material.roughness = std::nullopt;
  EXPECT_EQ(summary.messages(),
            (Messages{protocol::Batch{1, {protocol::ImageEdit{640, 480}, protocol::TechniqueEdit{"path-tracing", {{{"bounces", 2.0}}}}}},
                      edited(material)}));
  EXPECT_TRUE(summary.forget(chosen, "/technique")) << "its parameters are nobody else's";
  EXPECT_TRUE(summary.forget(material, "/material"));
  EXPECT_EQ(summary.messages(), (Messages{edited(protocol::ImageEdit{640, 480})}));
  EXPECT_FALSE(summary.forget(material, "/metallic"));
}

TEST(EditSummary, aSizeComesWithItsTechnique) {
  EditSummary summary;
  const protocol::ImageEdit size{640, 480};
  protocol::ResolveEdit display;
  display.exposure = 1.5f;
  const protocol::TechniqueEdit chosen{"point-projection", {}};
  for (const auto& edit : {edited(size), edited(display), edited(chosen), protocol::ClientMessage(protocol::Load{3, "b.glb"})})
    summary.add(edit);
  EXPECT_EQ(summary.messages(),
            (Messages{protocol::Load{1, "b.glb"}, protocol::Batch{1, {size, chosen}}, edited(display)}));
}

TEST(Journal, givesBackWhatWasAppended) {
  const test::ScratchDirectory scratch;
  const std::string file = scratch.file("room.edits");
  const Messages edits = someEdits();
  append(*opened(file), {edits.begin(), edits.begin() + 3});
  const auto again = opened(file);
  EXPECT_EQ(again->messages(), summaryOf(edits, 3));
  append(*again, {edits.begin() + 3, edits.end()});
  EXPECT_EQ(again->messages(), summaryOf(edits, edits.size()));
}

TEST(Journal, tornAnywhereItHoldsTheWholeLinesBefore) {
  const test::ScratchDirectory scratch;
  const std::string whole = scratch.file("whole"), torn = scratch.file("torn");
  const Messages edits = someEdits();
  std::vector<size_t> ends;             // of the file after so many messages
  {
    const auto journal = opened(whole);
    ends.push_back(journal->bytes());
    for (const auto& edit : edits) {
      append(*journal, {edit});
      ends.push_back(journal->bytes());
    }
  }
  const std::string bytes = bytesOf(whole);
  ASSERT_EQ(bytes.size(), ends.back());
  for (size_t length = 0; length <= bytes.size(); ++length) {
    std::ofstream(torn, std::ios::binary | std::ios::trunc) << bytes.substr(0, length);
    const size_t kept = std::upper_bound(ends.begin(), ends.end(), length) - ends.begin();
    const size_t count = kept > 0 ? kept - 1 : 0;
    {
      const auto journal = opened(torn);
      ASSERT_EQ(journal->messages(), summaryOf(edits, count)) << length << " bytes";
      append(*journal, {roughness(9, 0.5f)});
    }
    Messages more(edits.begin(), edits.begin() + long(count));
    more.push_back(roughness(9, 0.5f));
    ASSERT_EQ(opened(torn)->messages(), summaryOf(more, more.size())) << length << " bytes, and one more edit";
  }
}

TEST(Journal, aWrongBitEndsItThere) {
  const test::ScratchDirectory scratch;
  const std::string file = scratch.file("room.edits");
  append(*opened(file), {roughness(0, 0.1f), roughness(1, 0.2f), roughness(2, 0.3f)});
  std::string bytes = bytesOf(file);
  bytes[bytes.find("0.2")] ^= 1;
  std::ofstream(file, std::ios::binary) << bytes;
  EXPECT_EQ(opened(file)->messages(), (Messages{roughness(0, 0.1f)}));
}

TEST(Journal, staysSmallWhateverIsDragged) {
  const test::ScratchDirectory scratch;
  const std::string file = scratch.file("room.edits");
  {
    const auto journal = opened(file);
    append(*journal, {roughness(3, 0.5f)});
    for (int i = 0; i < 20000; ++i) append(*journal, {view(i)});
    EXPECT_LT(journal->bytes(), size_t(1) << 19);
  }
  EXPECT_EQ(opened(file)->messages(), (Messages{view(19999), roughness(3, 0.5f)}));
}

/// No file of the process grows beyond so many bytes, as if the disk were full.
class FullDisk {
 public:
  explicit FullDisk(uint64_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &m_before);
    const rlimit full{rlim_t(bytes), m_before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &full);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &m_before); }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit m_before{};
};

TEST(Journal, aFullDiskLosesNothingThatFitsLater) {
  const test::ScratchDirectory scratch;
  const std::string file = scratch.file("room.edits");
  const Messages edits{roughness(0, 0.25f), roughness(1, 0.5f), roughness(2, 0.75f), roughness(3, 1.0f)};
  {
    const auto journal = opened(file);
    append(*journal, {edits[0]});
    for (size_t i : {1u, 2u}) {
      const FullDisk full(journal->bytes() + 20);
      const Result<void> refused = journal->append(std::span(&edits[i], 1));
      ASSERT_FALSE(refused.ok());
      EXPECT_EQ(refused.error().code, "io");
      EXPECT_TRUE(journal->behind());
    }
    append(*journal, {edits[3]});
    EXPECT_FALSE(journal->behind());
  }
  EXPECT_EQ(opened(file)->messages(), edits);
}

TEST(Journal, catchesUpWithoutAnotherEdit) {
  const test::ScratchDirectory scratch;
  const std::string file = scratch.file("room.edits");
  const Messages edits{roughness(0, 0.25f), roughness(1, 0.5f)};
  {
    const auto journal = opened(file);
    append(*journal, {edits[0]});
    {
      const FullDisk full(journal->bytes() + 20);
      EXPECT_FALSE(journal->append(std::span(&edits[1], 1)).ok());
      EXPECT_FALSE(journal->catchUp().ok());
    }
    EXPECT_TRUE(journal->catchUp().ok());
    EXPECT_FALSE(journal->behind());
  }
  EXPECT_EQ(opened(file)->messages(), edits);
}

TEST(Journal, thatCannotBeShortenedStaysLong) {
  const test::ScratchDirectory scratch;
  const std::string file = scratch.file("room.edits");
  {
    const auto journal = opened(file);
    fs::create_directory(file + ".tmp." + std::to_string(getpid()));   // where a shorter one would be made
    for (int i = 0; i < 4000; ++i) append(*journal, {view(i)});
    EXPECT_GT(journal->bytes(), size_t(1) << 18);
    EXPECT_FALSE(journal->behind());
  }
  EXPECT_EQ(opened(file)->messages(), (Messages{view(3999)}));
}

TEST(Journal, refusesWhatIsNoneOrInUse) {
  const test::ScratchDirectory scratch;
  const std::string file = scratch.file("letter.txt"), used = scratch.file("room.edits");
  std::ofstream(file) << "Dear reader,\n";
  const auto foreign = Journal::open(file);
  ASSERT_FALSE(foreign.ok());
  EXPECT_EQ(foreign.error().code, "bad-file");
  EXPECT_EQ(bytesOf(file), "Dear reader,\n");
  const auto first = opened(used);
  const auto second = Journal::open(used);
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().code, "busy");
  EXPECT_EQ(Journal::open(scratch.file("nowhere/room.edits")).error().code, "io");
}

TEST(Journal, isSetAsideWhenStartsWithItComeToNothing) {
  const test::ScratchDirectory scratch;
  const std::string file = scratch.file("room.edits");
  const auto begun = [&] {
    auto journal = opened(file);
    EXPECT_TRUE(journal->begin().ok());
    return journal;
  };
  for (const char* value : {"0.25", "0.75"}) {
    append(*opened(file), {roughness(0, std::stof(value))});
    for (uint32_t i = 0; i < Journal::kMostStarts; ++i) EXPECT_EQ(begun()->messages().size(), 1u) << i;
    for (uint32_t i = 0; i < 2 * Journal::kMostStarts; ++i) EXPECT_TRUE(begun()->messages().empty()) << i;
  }
  EXPECT_NE(bytesOf(file + ".aside.1").find("0.25"), std::string::npos) << "nothing is thrown away";
  EXPECT_NE(bytesOf(file + ".aside.2").find("0.75"), std::string::npos);
  append(*opened(file), {roughness(0, 0.5f)});
  for (uint32_t i = 0; i < 2 * Journal::kMostStarts; ++i) {
    const auto journal = begun();
    EXPECT_EQ(journal->messages().size(), 1u) << i;
    journal->confirm();
  }
}

TEST(Journal, belongsToASceneByItsContents) {
  const test::ScratchDirectory scratch;
  const auto fileOf = [&](const std::string& name, const std::string& text) {
    std::ofstream(scratch.file(name), std::ios::binary) << text;
    return journalFileFor("kept", scratch.file(name)).take();
  };
  const fs::path first = fileOf("room.glb", "a room"), changed = fileOf("room.glb", "another room");
  EXPECT_NE(first, changed);
  EXPECT_EQ(fileOf("room.glb", "a room"), first);
  EXPECT_EQ(first.parent_path(), "kept");
  EXPECT_EQ(journalFileFor("kept", scratch.file("absent.glb")).error().code, "io");
}

TEST(Journal, isNotConfirmedByTheTimeThatLoadingTakes) {
  constexpr double kSafe = 0.25;       // [s]
  const test::ScratchDirectory scratch;
  const std::string file = scratch.file("room.edits");
  append(*opened(file), {roughness(0, 0.25f)});
  TestService::Options options;
  options.ready = false;
  options.kept = {roughness(0, 0.25f)};
  options.configure = [&](ServiceConfig& config) {
    config.journal = opened(file);
    config.safeSeconds = kSafe;
    EXPECT_TRUE(config.journal->begin().ok());
  };
  TestService server(options);
  const double begin = nowSeconds();
  while (nowSeconds() < begin + 2.0 * kSafe) server.metric("limn_clients");
  const auto starts = [&] { return bytesOf(file + ".lock"); };
  EXPECT_EQ(starts(), "1\n") << "nothing of it was seen to be safe";
  server.service->setReady(true);
  const double end = nowSeconds() + RawClient::kPatience;
  while (starts() != "0\n" && nowSeconds() < end) server.metric("limn_clients");
  EXPECT_EQ(starts(), "0\n");
}

TEST(Journal, holdsAnEditBeforeItIsAcknowledged) {
  const test::ScratchDirectory scratch;
  const std::string file = scratch.file("room.edits");
  TestService::Options options;
  options.configure = [&](ServiceConfig& config) { config.journal = opened(file); };
  TestService server(options);
  TestClient client(server.port());
  client.greet(false);
  client.await<protocol::SceneMessage>();
  // Read beside the server, which holds the lock.
  const auto kept = [&](const std::string& text) { return bytesOf(file).find(text) != std::string::npos; };
  uint32_t seq = client.nextSeq();
  client.send(setRoughness(seq, 1, 0.625f));
  client.awaitReply<protocol::Ack>(seq);
  EXPECT_TRUE(kept("0.625"));

  seq = client.nextSeq();
  client.send(setRoughness(seq, 99, 0.375f));
  client.awaitReply<protocol::ErrorMessage>(seq);
  EXPECT_FALSE(kept("0.375")) << "refused edits are not kept";

  protocol::SetCamera camera;
  camera.seq = client.nextSeq();
  camera.view.eye = {8.5, 0, 0};
  client.send(camera);
  client.awaitReply<protocol::Ack>(camera.seq);
  EXPECT_TRUE(kept("8.5"));
  EXPECT_TRUE(kept("yfov")) << "what the edit left out of the lens is completed";
}

}  // namespace
}  // namespace limn::server::testing
