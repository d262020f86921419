// The file that accepted edits are kept in: what comes back of it, whatever happened to it.
#include "server/journal.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "renderer/base/clock.hpp"
#include "tests/service/accepted_edits.hpp"
#include "tests/service/cli/run_program.hpp"
#include "tests/service/service_fixture.hpp"

namespace limn::server::testing {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<Journal> opened(const std::string& file) {
  Result<std::unique_ptr<Journal>> journal = Journal::open(file);
  EXPECT_TRUE(journal.ok()) << (journal ? "" : journal.error().text());
  return journal ? journal.take() : nullptr;
}

Result<void> tryAppend(Journal& journal, const Messages& messages) {
  std::vector<Accepted> accepted;
  for (const protocol::ClientMessage& message : messages) accepted.push_back({message});
  return journal.append(accepted);
}

void append(Journal& journal, const Messages& messages) {
  const Result<void> done = tryAppend(journal, messages);
  EXPECT_TRUE(done.ok()) << (done ? "" : done.error().text());
}

std::string bytesOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
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

TEST(Journal, knowsWhatALoadedFileHeld) {
  const test::ScratchDirectory scratch;
  const std::string file = scratch.file("room.edits");
  for (const uint64_t contents : {0ull, 0x0123456789abcdefull, ~0ull}) {
    const Accepted load{protocol::Load{1, "an,\"contents\":\"odd\"}.glb"}, contents};
    const std::vector<Accepted> messages{load, {roughness(0, 0.5f)}};
    EXPECT_TRUE(opened(file)->append(messages).ok());
    EXPECT_EQ(opened(file)->load(), load);
  }
  EXPECT_FALSE(opened(scratch.file("other.edits"))->load());
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
      const Result<void> refused = tryAppend(*journal, {edits[i]});
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
      EXPECT_FALSE(tryAppend(*journal, {edits[1]}).ok());
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
