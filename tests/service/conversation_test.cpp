// What a well-behaved client hears, from hello to bye.
#include <gmock/gmock.h>

#include "tests/service/service_fixture.hpp"

namespace limn::server::testing {
namespace {

using protocol::Encoding;
using ::testing::ElementsAre;

/// The seq of the edit.
uint32_t sendRoughness(TestClient& client, uint32_t material, float roughness) {
  const uint32_t seq = client.nextSeq();
  client.send(setRoughness(seq, material, roughness));
  return seq;
}

/// Edits five times, each after the edit before was acknowledged.
void editFiveTimes(TestClient& client) {
  for (int i = 0; i < 5; ++i) client.awaitReply<protocol::Ack>(sendRoughness(client, 0, 0.1f * float(i)));
}

/// Waits for so many steps or for the error, and without either for the end.
protocol::Waited waitFor(TestClient& client, std::optional<uint32_t> steps, std::optional<float> error) {
  const uint32_t seq = client.nextSeq();
  client.send(protocol::Wait{seq, steps, error});
  return client.awaitReply<protocol::Waited>(seq);
}

TEST(Conversation, helloIsAnsweredWithHelloSceneAndStatus) {
  TestService server;
  TestClient client(server.port());
  const protocol::ServerHello hello = client.greet();
  EXPECT_EQ(hello.seq, 1u);
  EXPECT_EQ(hello.version, 1u);
  EXPECT_EQ(hello.limits.framesInFlight, 2u);
  EXPECT_EQ(hello.limits.maxControlBytes, 1u << 20);
  ASSERT_EQ(hello.techniques.size(), 1u);
  EXPECT_EQ(hello.techniques[0].parameters.at(0).name, "depth");
  EXPECT_THAT(hello.encodings, ElementsAre(Encoding::jpeg, Encoding::png));
  EXPECT_EQ(hello.editable, protocol::editableTargets());
  const auto scene = client.await<protocol::SceneMessage>();
  EXPECT_EQ(scene.cause, protocol::SceneCause::joined);
  EXPECT_FALSE(scene.seq);
  EXPECT_EQ(scene.materials.size(), 2u);
}

TEST(Conversation, statusTellsTheDeviceAndTheClientsShare) {
  TestService server;
  TestClient client(server.port());
  client.greet();
  const auto status =
      client.await<protocol::Status>([](const protocol::Status& s) { return s.idle && s.framesSent > 0; });
  EXPECT_EQ(status.clients, 1u);
  EXPECT_EQ(status.technique, "fake");
  EXPECT_EQ(status.phase, protocol::Phase::converged);
  ASSERT_EQ(status.figures.size(), 1u);
  EXPECT_EQ(status.figures[0].first, "points");
  EXPECT_EQ(status.figures[0].second, 262144.0);
}

TEST(Conversation, pingIsAnsweredWithThePongOfItsSeq) {
  TestService server;
  TestClient client(server.port());
  client.greet();
  client.send(protocol::Ping{7});
  EXPECT_GT(client.awaitReply<protocol::Pong>(7).serverSeconds, 0.0);
}

TEST(Conversation, everyEditIsAcknowledgedWithItsCost) {
  TestService server;
  TestClient client(server.port());
  client.greet();
  uint32_t seq = sendRoughness(client, 1, 0.25f);
  EXPECT_EQ(client.awaitReply<protocol::Ack>(seq).cost, protocol::CostClass::relight);
  seq = client.nextSeq();
  client.send(moveCamera(seq, 3.0));
  EXPECT_EQ(client.awaitReply<protocol::Ack>(seq).cost, protocol::CostClass::reGather);
  seq = client.nextSeq();
  protocol::Batch batch{
      seq,
      {protocol::MaterialEdit{}, protocol::LightEdit{}, protocol::NodeEdit{}, protocol::EnvironmentEdit{},
       protocol::CameraEdit{}, protocol::TechniqueEdit{}, protocol::ResolveEdit{}, protocol::ImageEdit{64, 48}}};
  client.send(batch);
  EXPECT_EQ(client.awaitReply<protocol::Ack>(seq).seq, seq);
}

TEST(Conversation, everyTargetOfSetIsTaken) {
  TestService server;
  TestClient client(server.port());
  client.greet();
  protocol::CameraEdit camera;
  camera.view = moveCamera(0, 2.0).view;
  const std::vector<protocol::Edit> edits{protocol::MaterialEdit{}, protocol::LightEdit{}, protocol::NodeEdit{},
                                          protocol::EnvironmentEdit{}, camera, protocol::TechniqueEdit{},
                                          protocol::ResolveEdit{}, protocol::ImageEdit{64, 48}};
  for (const protocol::Edit& edit : edits) {
    const uint32_t seq = client.nextSeq();
    client.send(protocol::SetMessage{seq, edit});
    EXPECT_EQ(client.awaitReply<protocol::Ack>(seq).seq, seq) << protocol::targetOf(edit);
  }
}

TEST(Conversation, aPictureShowsTheEditThatItAcknowledges) {
  TestService server;
  TestClient client(server.port());
  client.greet();
  const uint32_t seq = sendRoughness(client, 0, 0.5f);
  const auto ack = client.awaitReply<protocol::Ack>(seq);
  const auto picture = client.awaitPicture([&](const protocol::FrameHeader& h) { return h.ackSeq == seq; });
  EXPECT_GE(picture.header.sceneRevision, ack.sceneRevision);
  EXPECT_EQ(picture.header.stageCount, 2);
  EXPECT_EQ(picture.header.stageMs[0], 1.5f);
}

TEST(Conversation, absentLensFieldsKeepTheirValue) {
  TestService server;
  TestClient client(server.port());
  client.greet();
  client.await<protocol::SceneMessage>();
  uint32_t seq = client.nextSeq();
  client.send(moveCamera(seq, 5.0));
  client.awaitReply<protocol::Ack>(seq);
  seq = client.nextSeq();
  client.send(protocol::Describe{seq});
  const auto scene = client.await<protocol::SceneMessage>([&](const auto& s) { return s.seq == seq; });
  EXPECT_EQ(scene.cause, protocol::SceneCause::asked);
  EXPECT_EQ(scene.view.eye[0], 5.0);
  EXPECT_EQ(scene.view.yfov, 0.625f);
}

TEST(Conversation, theFirstEditOfAllKeepsTheLensOfTheScene) {
  TestService::Options options;
  protocol::CameraEdit kept;           // by the journal
  kept.view = moveCamera(0, 3.0).view;
  kept.view.znear = 0.25f;
  options.kept = {protocol::Batch{1, {kept}}};
  TestService server(options);
  server.renderer->hold(true);         // it has described nothing yet
  TestClient client(server.port());
  client.greet();
  uint32_t seq = client.nextSeq();
  client.send(moveCamera(seq, 5.0));
  server.renderer->hold(false);
  client.awaitReply<protocol::Ack>(seq);
  seq = client.nextSeq();
  client.send(protocol::Describe{seq});
  const auto scene = client.await<protocol::SceneMessage>([&](const auto& s) { return s.seq == seq; });
  EXPECT_EQ(scene.view.yfov, 0.625f);
  EXPECT_EQ(scene.view.znear, 0.25f);
}

TEST(Conversation, pickNamesWhatIsThereOrNothing) {
  TestService server;
  TestClient client(server.port());
  client.greet();
  uint32_t seq = client.nextSeq();
  client.send(protocol::Pick{seq, 1, 1});
  EXPECT_TRUE(client.awaitReply<protocol::Picked>(seq).hit);
  seq = client.nextSeq();
  client.send(protocol::Pick{seq, 60, 1});
  const auto miss = client.awaitReply<protocol::Picked>(seq);
  EXPECT_FALSE(miss.hit);
  EXPECT_FALSE(miss.node);
}

TEST(Conversation, saveSendsAFileThatTakesNoCredit) {
  for (const size_t bytes : {size_t(300000), 3 * ClientSession::kMaxQueuedBytes}) {
    TestService::Options options;
    options.renderer.fileBytes = bytes;
    TestService server(options);
    TestClient client(server.port());
    client.greet(false);
    const uint32_t seq = client.nextSeq();
    client.send(protocol::Save{seq, std::vector<std::string>{"beauty"}});
    EXPECT_EQ(client.awaitReply<protocol::Saved>(seq).bytes, bytes);
    const auto file =
        client.awaitPicture([](const protocol::FrameHeader& h) { return h.kind == protocol::FrameKind::file; });
    EXPECT_EQ(file.header.ackSeq, seq);
    EXPECT_EQ(file.payload.size(), bytes);
    EXPECT_LE(client.longestFragment, protocol::kMaxFragmentBytes);
  }
}

TEST(Conversation, unknownLayerIsNamedInTheError) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  const uint32_t seq = client.nextSeq();
  client.send(protocol::Save{seq, std::vector<std::string>{"nonsense"}});
  const auto error = client.await<protocol::ErrorMessage>();
  EXPECT_EQ(error.code, "unknown-name");
  EXPECT_THAT(error.message, ::testing::HasSubstr("nonsense"));
}

TEST(Conversation, waitIsAnsweredAtTheSteps) {
  TestService server;
  TestClient client(server.port());
  client.greet();
  EXPECT_GE(waitFor(client, 2u, {}).steps, 2u);
  EXPECT_EQ(waitFor(client, {}, {}).steps, 4u);
}

TEST(Conversation, waitForAnErrorIsAnsweredOnceThePictureIsSoGood) {
  TestService server;
  TestClient client(server.port());
  client.greet();
  sendRoughness(client, 0, 0.75f);
  EXPECT_GE(waitFor(client, {}, 0.34f).steps, 3u);
}

TEST(Conversation, waitForStepsAndAnErrorIsAnsweredWhenBothAreReached) {
  TestService server;
  TestClient client(server.port());
  client.greet();
  sendRoughness(client, 0, 0.75f);
  EXPECT_GE(waitFor(client, 1u, 0.67f).steps, 3u) << "steps come first";
  sendRoughness(client, 0, 0.5f);
  EXPECT_GE(waitFor(client, 3u, 2.0f).steps, 3u) << "the error comes first";
}

TEST(Conversation, waitForAnErrorIsAnsweredAlsoWhenNobodyWatches) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  client.awaitReply<protocol::Ack>(sendRoughness(client, 0, 0.75f));
  EXPECT_GE(waitFor(client, {}, 0.34f).steps, 3u);
  EXPECT_EQ(client.picturesSeen, 0u) << "waiting is not watching";

  // Afterwards the renderer rests again: what is edited now is shown to nobody.
  client.awaitReply<protocol::Ack>(sendRoughness(client, 0, 0.5f));
  const uint64_t published = server.renderer->framesPublished();
  editFiveTimes(client);
  EXPECT_EQ(server.renderer->framesPublished(), published);
}

TEST(Conversation, waitForAnErrorIsNotHeldUpByAnEditThatFailed) {
  TestService server;
  TestClient client(server.port());
  client.greet();
  sendRoughness(client, 99, 0.75f);
  EXPECT_GE(waitFor(client, {}, 0.5f).steps, 2u);
}

TEST(Conversation, anEditIsToldToTheOthersAndNotToItsAuthor) {
  TestService server;
  TestClient author(server.port()), other(server.port());
  author.greet();
  other.greet();
  other.await<protocol::SceneMessage>();
  sendRoughness(author, 1, 0.125f);
  const auto scene = other.await<protocol::SceneMessage>();
  EXPECT_EQ(scene.cause, protocol::SceneCause::edited);
  EXPECT_EQ(scene.materials.at(1).roughness, 0.125f);
  author.send(protocol::Ping{author.nextSeq()});
  while (author.step() && !(author.text && std::holds_alternative<protocol::Pong>(*author.text)))
    if (author.text && std::holds_alternative<protocol::SceneMessage>(*author.text)) {
      EXPECT_NE(std::get<protocol::SceneMessage>(*author.text).cause, protocol::SceneCause::edited);
    }
}

TEST(Conversation, anEditIsToldAlsoWhenItsAuthorHasLeft) {
  TestService server;
  TestClient other(server.port());
  other.greet();
  const auto roughness = [](float value) {
    return [value](const protocol::SceneMessage& scene) { return scene.materials.at(1).roughness == value; };
  };
  {
    TestClient author(server.port());
    author.greet(false);
    sendRoughness(author, 1, 0.125f);
    other.await<protocol::SceneMessage>(roughness(0.125f));
    author.awaitReply<protocol::Ack>(sendRoughness(author, 1, 0.25f));   // the next scene is told a while after the last
  }
  EXPECT_EQ(other.await<protocol::SceneMessage>(roughness(0.25f)).cause, protocol::SceneCause::edited);
}

TEST(Conversation, byeIsAnsweredAndTheSocketClosesWith1000) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  client.send(protocol::ClientBye{client.nextSeq()});
  client.await<protocol::ServerBye>();
  while (client.step()) {
  }
  EXPECT_EQ(client.closeCode, 1000);
}

TEST(Conversation, drainSaysByeAndClosesWith1001) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  server.service->drain();
  client.await<protocol::ServerBye>();
  while (client.step()) {
  }
  EXPECT_EQ(client.closeCode, 1001);
  server.loop.join();
  server.loop = std::thread([] {});
}

TEST(Conversation, theEndOfTheRendererIsToldToAll) {
  TestService server;
  TestClient first(server.port()), second(server.port());
  first.greet(false);
  second.greet(false);
  server.replies.push(ErrorReply{{}, {"device-lost", "the device was lost", ""}});
  for (TestClient* client : {&first, &second}) {
    const auto error = client->await<protocol::ErrorMessage>();
    EXPECT_EQ(error.code, "device-lost");
    EXPECT_FALSE(error.seq);
  }
  server.service->drain();
  while (first.step()) {
  }
  EXPECT_EQ(first.closeCode, 1011);
}

TEST(Conversation, clientsThatDoNotWatchGetNoPictures) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  editFiveTimes(client);
  EXPECT_EQ(client.picturesSeen, 0u);
  EXPECT_EQ(server.renderer->framesPublished(), 0u);
}

}  // namespace
}  // namespace limn::server::testing
