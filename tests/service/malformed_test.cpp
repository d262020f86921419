// Wrong messages are answered with the right error, and everything goes on as before.
#include "tests/service/service_fixture.hpp"

namespace limn::server::testing {
namespace {

struct Wrong {
  const char* name;
  std::string text;
  const char* code;
};

std::string nested(size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); }

/// Each is sent after hello (seq 1); the seqs rise from case to case.
const std::vector<Wrong>& wrongMessages() {
  static const std::vector<Wrong> cases{
      {"empty", "", "bad-message"},
      {"notJson", "hello", "bad-message"},
      {"halfAnObject", R"({"op":"ping","seq":2)", "bad-message"},
      {"trailingBytes", R"({"op":"ping","seq":2} x)", "bad-message"},
      {"anArray", R"([1,2,3])", "bad-message"},
      {"aNumber", "7", "bad-message"},
      {"noOp", R"({"seq":3})", "bad-message"},
      {"opOfWrongType", R"({"op":7,"seq":4})", "bad-message"},
      {"unknownOp", R"({"op":"explode","seq":5})", "unknown-op"},
      {"noSeq", R"({"op":"ping"})", "bad-message"},
      {"seqZero", R"({"op":"ping","seq":0})", "out-of-range"},
      {"seqNegative", R"({"op":"ping","seq":-1})", "out-of-range"},
      {"seqTooLarge", R"({"op":"ping","seq":4294967296})", "out-of-range"},
      {"seqNotWhole", R"({"op":"ping","seq":6.5})", "bad-message"},
      {"seqDoesNotRise", R"({"op":"ping","seq":1})", "bad-seq"},
      {"unknownField", R"({"op":"ping","seq":10,"extra":1})", "bad-message"},
      {"fieldTwice", R"({"op":"ping","seq":11,"seq":12})", "bad-message"},
      {"missingField", R"({"op":"pick","seq":13,"x":1})", "bad-message"},
      {"wrongType", R"({"op":"pick","seq":14,"x":"1","y":1})", "bad-message"},
      {"outOfRange", R"({"op":"set","seq":15,"target":"material","material":0,"roughness":2})", "out-of-range"},
      {"notANumber", R"({"op":"set","seq":16,"target":"material","material":0,"roughness":NaN})", "bad-message"},
      {"tooLargeForDouble", R"({"op":"set","seq":17,"target":"light","light":0,"intensity":1e999})", "out-of-range"},
      {"noTarget", R"({"op":"set","seq":18,"material":0})", "bad-message"},
      {"unknownTarget", R"({"op":"set","seq":19,"target":"cloud"})", "out-of-range"},
      {"indexOutOfRange", R"({"op":"set","seq":20,"target":"material","material":99,"roughness":0.5})", "out-of-range"},
      {"shortVector", R"({"op":"camera","seq":21,"eye":[0,0],"target":[0,0,0],"up":[0,1,0]})", "bad-message"},
      {"emptyBatch", R"({"op":"batch","seq":22,"edits":[]})", "out-of-range"},
      {"wrongEditInBatch",
       R"({"op":"batch","seq":23,"edits":[{"target":"light","light":0},{"target":"light","light":0,"range":-1}]})",
       "out-of-range"},
      {"unknownToneMap", R"({"op":"set","seq":24,"target":"resolve","toneMap":"sepia"})", "out-of-range"},
      {"imageTooLarge", R"({"op":"set","seq":25,"target":"image","width":8192,"height":64})", "out-of-range"},
      {"imageTooSmall", R"({"op":"set","seq":26,"target":"image","width":1,"height":64})", "out-of-range"},
      {"ackOfNoFrame", R"({"op":"ackFrame","seq":27,"frameId":4000000000,"dropped":false})", "bad-ack"},
      {"unknownLayer", R"({"op":"save","seq":28,"layers":["smell"]})", "unknown-name"},
      {"secondHello", R"({"op":"hello","seq":29,"version":1,"client":"again"})", "hello-first"},
      {"deepNesting", R"({"op":"batch","seq":30,"edits":)" + nested(64) + "}", "limit"},
      {"veryDeepNesting", nested(200000), "limit"},
      {"loneSurrogate", R"({"op":"load","seq":31,"uri":"\ud800"})", "bad-message"},
      {"controlCharacter", "{\"op\":\"load\",\"seq\":32,\"uri\":\"a\nb\"}", "bad-message"},
      {"longString", R"({"op":"load","seq":33,"uri":")" + std::string(5000, 'a') + "\"}", "out-of-range"},
      {"absolutePath", R"({"op":"load","seq":34,"uri":"/etc/passwd"})", "io"},
      {"pathOutOfTheRoot", R"({"op":"load","seq":35,"uri":"../../etc/passwd"})", "io"},
      {"noSuchFile", R"({"op":"load","seq":36,"uri":"no-such-scene.glb"})", "io"},
      {"directoryAsFile", R"({"op":"load","seq":37,"uri":"."})", "io"},
      {"unknownView", R"({"op":"set","seq":38,"target":"resolve","view":"camera"})", "out-of-range"},
  };
  return cases;
}

TEST(Malformed, eachIsAnsweredWithItsErrorAndTheServerGoesOn) {
  TestService server;
  TestClient client(server.port());
  client.greet(false);
  const auto before = client.await<protocol::SceneMessage>();
  for (const Wrong& wrong : wrongMessages()) {
    client.sendWrong(wrong.text);
    const auto error = client.await<protocol::ErrorMessage>();
    EXPECT_EQ(error.code, wrong.code) << wrong.name << ": " << error.message << " at " << error.place.value_or("-");
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
