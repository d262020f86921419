// Wrong messages are answered with the right error, and everything goes on as before.
#include "tests/service/service_fixture.hpp"
#include "tests/service/wrong_messages.hpp"

namespace limn::server::testing {
namespace {

TEST(Malformed, eachIsAnsweredWithItsErrorAndTheServerGoesOn) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  const auto before = client.await<protocol::SceneMessage>();
  for (const WrongMessage& wrong : wrongMessages()) {
    client.sendWrong(wrong.text);
    const auto error = client.await<protocol::ErrorMessage>();
    EXPECT_EQ(error.code, wrong.code) << wrong.name << ": " << error.message;
    EXPECT_EQ(error.place.value_or(""), wrong.place) << wrong.name << ": " << error.message;
    EXPECT_FALSE(error.message.empty()) << wrong.name;
  }
  client.send(protocol::Describe{1000});
  auto after = client.await<protocol::SceneMessage>();
  EXPECT_EQ(after.sceneRevision, before.sceneRevision);
  EXPECT_EQ(after.hash, before.hash);
  EXPECT_EQ(server.metric("limn_errors_total"), double(wrongMessages().size()));
}

TEST(Malformed, beforeHelloNothingIsTaken) {
  TestService server;
  TestClient client(server.port());
  client.sendWrong(R"({"op":"ping","seq":1})");
  EXPECT_EQ(client.await<protocol::ErrorMessage>().code, "hello-first");
  client.sendWrong(R"({"op":"nonsense","seq":2})");
  EXPECT_EQ(client.await<protocol::ErrorMessage>().code, "unknown-op");
  while (client.nextSeq() < 2) {
  }
  EXPECT_EQ(client.greet().seq, 3u);
}

TEST(Malformed, anotherVersionIsToldAndClosed) {
  TestService server;
  TestClient client(server.port());
  client.sendWrong(R"({"op":"hello","seq":1,"version":2,"client":"new"})");
  EXPECT_EQ(client.await<protocol::ErrorMessage>().code, "version");
  while (client.step()) {
  }
  EXPECT_EQ(client.closeCode, 1008);
}

TEST(Malformed, aTokenBelongsIntoTheHandshakeAndNotIntoHello) {
  TestService::Options options;
  options.configure = [](ServiceConfig& config) { config.transport.access.token = "secret-7"; };
  TestService server(options);
  EXPECT_EQ(RawClient().upgrade(server.port(), {}), 401);
  EXPECT_EQ(RawClient().upgrade(server.port(), {{"Authorization", "Bearer secret-8"}}), 401);
  RawClient socket;
  ASSERT_EQ(socket.upgrade(server.port(), {{"Authorization", "Bearer secret-7"}}), 101);
  socket.sendText(R"({"op":"hello","seq":1,"version":1,"client":"x","token":"secret-7"})");
  EXPECT_NE(socket.receive()->payload.find("bad-message"), std::string::npos);
  socket.sendText(R"({"op":"hello","seq":2,"version":1,"client":"x"})");
  EXPECT_NE(socket.receive()->payload.find(R"("op":"hello")"), std::string::npos);
}

TEST(Malformed, binaryMessagesCloseWith1003) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  client.socket.sendFrame(RawClient::Opcode::binary, "abc");
  EXPECT_EQ(client.socket.waitForClose(), 1003);
}

TEST(Malformed, textThatIsNotUtf8ClosesWith1007) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  client.socket.sendText("{\"op\":\"load\",\"uri\":\"\xc3\x28\"}");
  EXPECT_EQ(client.socket.waitForClose(), 1007);
}

TEST(Malformed, reservedBitsAndOpcodesEndTheConnection) {
  TestService server;
  for (const std::string& bytes :
       {std::string("\xc1\x80\x00\x00\x00\x00", 6), std::string("\x83\x80\x00\x00\x00\x00", 6),
        std::string("\x80\x80\x00\x00\x00\x00", 6)}) {
    TestClient client(server.port());
    client.greet(false);
    client.socket.sendBytes(bytes);
    client.socket.waitForClose();
    EXPECT_FALSE(client.socket.timedOut()) << int(uint8_t(bytes[0]));
  }
  TestClient after(server.port());
  after.greet();
}

TEST(Malformed, theHelloTimerClosesSilentSockets) {
  TestService::Options options;
  options.configure = [](ServiceConfig& config) { config.helloSeconds = 0.1; };
  TestService server(options);
  RawClient silent;
  ASSERT_EQ(silent.upgrade(server.port()), 101);
  EXPECT_EQ(silent.waitForClose(), 1008);
  EXPECT_FALSE(silent.timedOut());
}

}  // namespace
}  // namespace limn::server::testing
