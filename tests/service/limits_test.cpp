// Every limit holds, and not too early.
#include "tests/service/service_fixture.hpp"

namespace limn::server::testing {
namespace {

/// A ping padded with blanks to `size` bytes.
std::string paddedPing(uint32_t seq, size_t size) {
  std::string text = R"({"op":"ping","seq":)" + std::to_string(seq);
  text.append(size - text.size() - 1, ' ');
  return text + "}";
}

TEST(Limits, aMessageAtTheLimitIsTaken) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  client.sendWrong(paddedPing(2, protocol::kMaxControlBytes));
  EXPECT_EQ(client.awaitReply<protocol::Pong>(2).seq, 2u);
}

TEST(Limits, aMessageOneByteOverTheLimitClosesWith1009) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  client.socket.sendText(paddedPing(2, protocol::kMaxControlBytes + 1));
  EXPECT_EQ(client.socket.waitForClose(), 1009);
  EXPECT_EQ(server.metric("limn_messages_oversized_total"), 1.0);
}

TEST(Limits, anAnnouncedHugeMessageIsNotWaitedFor) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  const std::string header("\x81\xff\x00\x00\x7f\xff\xff\xff\xff\xff\x01\x02\x03\x04", 14);
  client.socket.sendBytes(header + std::string(protocol::kMaxControlBytes + 1, 'x'));
  EXPECT_EQ(client.socket.waitForClose(), 1009);
}

TEST(Limits, fragmentsAreJoinedUpToTheirLimit) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  const std::string text = paddedPing(2, protocol::kMaxFragments);
  std::string bytes;
  for (size_t i = 0; i < text.size(); ++i)
    bytes += frameBytes(i == 0 ? RawClient::Opcode::text : RawClient::Opcode::continuation, text.substr(i, 1),
                        i + 1 == text.size(), true);
  client.socket.sendBytes(bytes);
  EXPECT_EQ(client.awaitReply<protocol::Pong>(2).seq, 2u);
}

TEST(Limits, oneFragmentMoreClosesWith1008) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  const std::string text = paddedPing(2, protocol::kMaxFragments + 1);
  std::string bytes;
  for (size_t i = 0; i < text.size(); ++i)
    bytes += frameBytes(i == 0 ? RawClient::Opcode::text : RawClient::Opcode::continuation, text.substr(i, 1),
                        i + 1 == text.size(), true);
  client.socket.sendBytes(bytes);
  EXPECT_EQ(client.socket.waitForClose(), 1008);
}

TEST(Limits, emptyFragmentsCloseWith1008) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  client.socket.sendFrame(RawClient::Opcode::text, "", false);
  client.socket.sendFrame(RawClient::Opcode::continuation, "", false);
  EXPECT_EQ(client.socket.waitForClose(), 1008);
}

TEST(Limits, controlFramesMayStandBetweenFragments) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  const std::string text = paddedPing(2, 100);
  client.socket.sendFrame(RawClient::Opcode::text, text.substr(0, 50), false);
  client.socket.sendFrame(RawClient::Opcode::ping, "are you there");
  client.socket.sendFrame(RawClient::Opcode::continuation, text.substr(50), true);
  bool ponged = false, answered = false;
  while (!(ponged && answered)) {
    const auto message = client.socket.receive();
    ASSERT_TRUE(message);
    ponged |= message->opcode == RawClient::Opcode::pong && message->payload == "are you there";
    answered |= message->payload.find("\"pong\"") != std::string::npos;
  }
}

TEST(Limits, whoSendsTooFastIsSlowedDownAndNotClosed) {
  TestService::Options options;
  options.configure = [](ServiceConfig& config) {
    config.transport.messagesPerSecond = 1000;
    config.transport.messageBurst = 50;
  };
  TestService server(options);
  TestClient client(server.port());
  client.greet(false);
  constexpr uint32_t kMessages = 400;
  for (uint32_t seq = 2; seq < 2 + kMessages; ++seq) client.send(protocol::Ping{seq});
  for (uint32_t seq = 2; seq < 2 + kMessages; ++seq) ASSERT_EQ(client.awaitReply<protocol::Pong>(seq).seq, seq);
  EXPECT_GE(server.metric("limn_read_pauses_total"), 1.0);
}

TEST(Limits, slowSendingIsNotPaused) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  for (uint32_t seq = 2; seq < 102; ++seq) {
    client.send(protocol::Ping{seq});
    client.awaitReply<protocol::Pong>(seq);
  }
  EXPECT_EQ(server.metric("limn_read_pauses_total"), 0.0);
}

TEST(Limits, aBatchOverTheLimitIsRefusedAndOneAtTheLimitIsTaken) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  const auto batchOf = [](uint32_t seq, uint32_t edits) {
    std::string text = R"({"op":"batch","seq":)" + std::to_string(seq) + R"(,"edits":[)";
    for (uint32_t i = 0; i < edits; ++i)
      text += std::string(i ? "," : "") + R"({"target":"material","material":0,"metallic":1})";
    return text + "]}";
  };
  client.sendWrong(batchOf(2, protocol::kMaxEditsPerBatch));
  EXPECT_EQ(client.awaitReply<protocol::Ack>(2).seq, 2u);
  client.sendWrong(batchOf(3, protocol::kMaxEditsPerBatch + 1));
  EXPECT_EQ(client.await<protocol::ErrorMessage>().seq, 3u);
}

TEST(Limits, aSceneThatIsTooLongToBeToldIsAnError) {
  TestService::Options options;
  options.renderer.materials = 200000;
  TestService server(options);
  TestClient client(server.port());
  client.greet(false);
  const auto joining = client.await<protocol::ErrorMessage>();
  EXPECT_EQ(joining.code, "limit");
  EXPECT_FALSE(joining.seq);
  const uint32_t seq = client.nextSeq();
  client.send(protocol::Describe{seq});
  const auto asked = client.await<protocol::ErrorMessage>();
  EXPECT_EQ(asked.code, "limit");
  EXPECT_EQ(asked.seq, seq);
}

TEST(Limits, aFullMailboxIsToldAsBusy) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  client.await<protocol::SceneMessage>();
  server.renderer->hold(true);
  const uint32_t first = client.nextSeq();
  constexpr uint32_t kOver = 10;
  for (uint32_t i = 0; i < ClientSession::kMaxUnanswered + kOver; ++i)
    client.sendWrong(R"({"op":"set","target":"material","material":0,"seq":)" + std::to_string(first + i) + "}");
  for (uint32_t i = 0; i < kOver; ++i) {
    const auto error = client.await<protocol::ErrorMessage>();
    EXPECT_EQ(error.code, "busy");
    EXPECT_EQ(error.seq, first + ClientSession::kMaxUnanswered + i);
  }
  server.renderer->hold(false);
  EXPECT_EQ(client.awaitReply<protocol::Ack>(first + ClientSession::kMaxUnanswered - 1).cost,
            protocol::CostClass::relight);
}

}  // namespace
}  // namespace limn::server::testing
