// Pictures: credits, latest wins, sharing, losslessness.
#include "tests/service/service_fixture.hpp"

namespace limn::server::testing {
namespace {

using protocol::Encoding;

TestService::Options endless(bool noisy = false) {
  TestService::Options options;
  options.renderer.passes = 1u << 30;
  options.renderer.noisy = noisy;
  return options;
}

std::vector<uint8_t> rgbOf(const FakeRenderer::Options& options, uint64_t frameId) {
  const std::vector<uint8_t> rgba = FakeRenderer::pixels(options, frameId);
  std::vector<uint8_t> rgb;
  for (size_t i = 0; i < rgba.size(); ++i)
    if (i % 4 != 3) rgb.push_back(rgba[i]);
  return rgb;
}

/// Returns once the renderer has published so many pictures more.
void publishMore(const TestService& server, uint64_t pictures) {
  const uint64_t target = server.renderer->framesPublished() + pictures;
  while (server.renderer->framesPublished() < target) std::this_thread::yield();
}

TEST(Frames, thePictureAtRestIsLossless) {
  TestService server;
  TestClient client(server.port());
  client.greet();
  const auto last = client.awaitPicture([](const auto& h) { return h.flags & protocol::kFrameFinal; });
  EXPECT_EQ(last.header.encoding, Encoding::png);
  EXPECT_TRUE(last.header.flags & protocol::kFrameLossless);
  EXPECT_EQ(last.header.phase, protocol::Phase::converged);
  EXPECT_EQ(last.header.quality, 0);
  uint32_t width = 0, height = 0;
  EXPECT_EQ(decodeImage(last.payload, Encoding::png, width, height), rgbOf({}, last.header.frameId));
  EXPECT_EQ(width, last.header.imageWidth);
  EXPECT_EQ(height, last.header.fullHeight);
}

TEST(Frames, whoComesLateGetsThePictureAtRestAtOnce) {
  TestService server;
  TestClient first(server.port());
  first.greet();
  first.awaitPicture([](const auto& h) { return h.flags & protocol::kFrameFinal; });
  TestClient second(server.port());
  second.greet();
  EXPECT_TRUE(second.awaitPicture().header.flags & protocol::kFrameFinal);
  EXPECT_EQ(second.picturesSeen, 1u);
}

/// A client joins while the renderer draws and does not look into its mailbox; `meanwhile` is what others do.
void expectSceneBeforePictures(TestService& server, const std::function<void()>& meanwhile = [] {}) {
  server.renderer->keepBusy(true);
  publishMore(server, 1);
  TestClient client(server.port());
  client.greet();
  const uint64_t atHello = server.renderer->framesPublished();
  meanwhile();
  // Three pictures at most are of the time before: one not counted yet, one being encoded, and one to be encoded next.
  const double encoded = server.metric("limn_frames_encoded_total");
  while (server.metric("limn_frames_encoded_total") < encoded + 4) std::this_thread::yield();
  const uint32_t ping = client.nextSeq();
  client.send(protocol::Ping{ping});
  ASSERT_TRUE(client.step());
  ASSERT_TRUE(client.text && std::holds_alternative<protocol::Pong>(*client.text)) << "it came before the scene";

  server.renderer->keepBusy(false);
  ASSERT_TRUE(client.step());
  ASSERT_TRUE(client.text && std::holds_alternative<protocol::SceneMessage>(*client.text));
  EXPECT_EQ(std::get<protocol::SceneMessage>(*client.text).cause, protocol::SceneCause::joined);
  ASSERT_TRUE(client.step());
  ASSERT_TRUE(client.text && std::holds_alternative<protocol::Status>(*client.text));
  EXPECT_GT(client.awaitPicture().header.frameId, atHello) << "an older picture was kept";
}

TEST(Frames, theFirstClientHearsOfTheSceneBeforeItSeesPictures) {
  TestService::Options options = endless();
  options.renderer.watched = true;
  TestService server(options);
  expectSceneBeforePictures(server);
}

TEST(Frames, aJoiningClientDoesNotHoldUpThePicturesOfOthers) {
  TestService server(endless());
  TestClient first(server.port());
  first.greet();
  first.awaitPicture();
  expectSceneBeforePictures(server, [&] {
    for (int i = 0; i < 20; ++i) first.awaitPicture();
  });
}

TEST(Frames, movingPicturesAreJpegOfThePublishedSize) {
  TestService server(endless());
  TestClient client(server.port());
  client.greet();
  const auto picture = client.awaitPicture();
  EXPECT_EQ(picture.header.encoding, Encoding::jpeg);
  uint32_t width = 0, height = 0;
  decodeImage(picture.payload, Encoding::jpeg, width, height);
  EXPECT_EQ(width, 64u);
  EXPECT_EQ(height, 48u);
}

TEST(Frames, onlyEncodingsThatTheClientTakesAreSent) {
  TestService server;
  TestClient png(server.port()), jpeg(server.port());
  png.greet(std::nullopt, std::vector<Encoding>{Encoding::png});
  jpeg.greet(std::nullopt, std::vector<Encoding>{Encoding::jpeg});
  const auto isLast = [](const auto& h) { return h.phase == protocol::Phase::converged; };
  EXPECT_EQ(png.awaitPicture().header.encoding, Encoding::png);
  EXPECT_EQ(png.awaitPicture(isLast).header.encoding, Encoding::png);
  const auto last = jpeg.awaitPicture(isLast);
  EXPECT_EQ(last.header.encoding, Encoding::jpeg);
  EXPECT_FALSE(last.header.flags & protocol::kFrameLossless);
}

TEST(Frames, neverMoreThanTwoInFlight) {
  TestService server(endless());
  TestClient client(server.port());
  client.acknowledges = false;
  client.greet();
  const auto first = client.awaitPicture(), second = client.awaitPicture();
  // The renderer goes on; the ping's answer is behind anything the server would have sent.
  publishMore(server, 20);
  const uint32_t seq = client.nextSeq();
  client.send(protocol::Ping{seq});
  client.awaitReply<protocol::Pong>(seq);
  EXPECT_EQ(client.picturesSeen, 2u);

  client.acknowledge(first.header.frameId);
  const auto third = client.awaitPicture();
  EXPECT_GE(third.header.frameId, second.header.frameId + 15) << "the newest picture was to be sent";
  EXPECT_GE(third.header.replaced, 15u) << "what was replaced is to be told";
  EXPECT_EQ(third.header.replaced, third.header.frameId - first.header.frameId - 2);
}

TEST(Frames, anAcknowledgementCountsOnce) {
  TestService server(endless());
  TestClient client(server.port());
  client.acknowledges = false;
  client.greet();
  const auto first = client.awaitPicture();
  client.awaitPicture();
  for (int i = 0; i < 5; ++i) client.acknowledge(first.header.frameId);
  client.awaitPicture();
  const uint32_t seq = client.nextSeq();
  client.send(protocol::Ping{seq});
  client.awaitReply<protocol::Pong>(seq);
  EXPECT_EQ(client.picturesSeen, 3u);
}

TEST(Frames, missingAcknowledgementsCloseWith1008) {
  TestService::Options options = endless();
  options.configure = [](ServiceConfig& config) { config.ackSeconds = 0.2; };
  TestService server(options);
  TestClient lazy(server.port());
  lazy.acknowledges = false;
  lazy.greet();
  while (lazy.step()) {
  }
  EXPECT_EQ(lazy.closeCode, 1008);
}

TEST(Frames, frameIdsRiseAndRevisionsNeverFall) {
  TestService server(endless());
  TestClient client(server.port());
  client.greet();
  protocol::FrameHeader last;
  for (int i = 0; i < 100; ++i) {
    if (i % 10 == 0) client.send(setRoughness(client.nextSeq(), 0, 0.005f * float(i)));
    const auto header = client.awaitPicture().header;
    EXPECT_GT(header.frameId, last.frameId);
    EXPECT_GE(header.sceneRevision, last.sceneRevision);
    EXPECT_GE(header.ackSeq, last.ackSeq);
    last = header;
  }
}

TEST(Frames, clientsThatShareAPictureGetItUncorrupted) {
  TestService::Options options = endless(true);
  options.renderer.width = 400;        // PNG of noise: several fragments a picture
  options.renderer.height = 300;
  TestService server(options);
  std::vector<std::thread> readers;
  std::mutex mutex;
  std::map<uint32_t, std::vector<uint32_t>> crcs;   // by frame, of every client
  for (int i = 0; i < 3; ++i)
    readers.emplace_back([&] {
      TestClient client(server.port());
      client.greet(std::nullopt, std::vector<Encoding>{Encoding::png});
      for (int n = 0; n < 40; ++n) {
        const auto picture = client.awaitPicture();
        uint32_t width = 0, height = 0;
        EXPECT_EQ(decodeImage(picture.payload, Encoding::png, width, height),
                  rgbOf(options.renderer, picture.header.frameId));
        const std::lock_guard lock(mutex);
        crcs[picture.header.frameId].push_back(picture.header.crc32c);
      }
      EXPECT_EQ(client.longestFragment, protocol::kMaxFragmentBytes);
    });
  for (std::thread& reader : readers) reader.join();
  size_t shared = 0;
  for (const auto& [frame, values] : crcs) {
    shared += values.size() > 1;
    for (const uint32_t crc : values) EXPECT_EQ(crc, values[0]);
  }
  EXPECT_GT(shared, 0u) << "no picture was seen by two";
  EXPECT_LT(server.metric("limn_frames_encoded_total"), server.metric("limn_frames_sent_total"))
      << "nothing was shared";
}

TEST(Frames, nothingIsEncodedWithoutACredit) {
  TestService server(endless());
  TestClient client(server.port());
  client.acknowledges = false;
  client.greet();
  client.awaitPicture();
  client.awaitPicture();
  const double encoded = server.metric("limn_frames_encoded_total");
  publishMore(server, 50);
  EXPECT_EQ(server.metric("limn_frames_encoded_total"), encoded);
  EXPECT_LE(encoded, 3.0);
}

TEST(Frames, anEditStormIsAcknowledgedToTheLastSeqAndPicturesGoOn) {
  TestService server;
  TestClient client(server.port());
  client.greet();
  constexpr uint32_t kEdits = 600;
  std::map<uint32_t, bool> superseded;
  uint32_t first = 0, pictures = 0;
  for (uint32_t i = 0; i < kEdits; ++i) {
    const uint32_t seq = client.nextSeq();
    if (first == 0) first = seq;
    if (i % 5 == 0) client.send(setRoughness(seq, i % 2, float(i) / kEdits));
    else client.send(moveCamera(seq, double(i)));
    superseded[seq] = false;
  }
  size_t answered = 0;
  while (answered < kEdits && client.step()) {
    pictures += client.picture.has_value();
    if (!client.text) continue;
    if (const auto* ack = std::get_if<protocol::Ack>(&*client.text)) {
      ASSERT_TRUE(superseded.count(ack->seq));
      superseded.erase(ack->seq);
      ++answered;
    }
    EXPECT_FALSE(std::holds_alternative<protocol::ErrorMessage>(*client.text));
  }
  EXPECT_TRUE(superseded.empty()) << superseded.size() << " edits were not answered";
  // The edits were sent in one row: pictures were not read in between, so none was acknowledged.
  const uint32_t lastEdit = first + kEdits - 1;
  client.awaitPicture([&](const auto& h) { return h.phase == protocol::Phase::converged && h.ackSeq == lastEdit; });
}

TEST(Frames, whileAnEditIsHeldLaterCameraEditsReplaceEarlierOnes) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  client.await<protocol::SceneMessage>();
  server.renderer->hold(true);
  std::vector<uint32_t> seqs;
  for (int i = 0; i < 10; ++i) {
    seqs.push_back(client.nextSeq());
    client.send(moveCamera(seqs.back(), i));
  }
  const uint32_t ping = client.nextSeq();
  client.send(protocol::Ping{ping});
  client.awaitReply<protocol::Pong>(ping);
  server.renderer->hold(false);
  std::map<uint32_t, bool> superseded;
  while (superseded.size() < seqs.size()) {
    const auto ack = client.await<protocol::Ack>();
    superseded[ack.seq] = ack.superseded;
  }
  for (const uint32_t seq : seqs) EXPECT_EQ(superseded[seq], seq != seqs.back()) << seq;
}

}  // namespace
}  // namespace limn::server::testing
