// What a server refuses, with code and place, and that refusing is all it does.
#include <random>

#include <gtest/gtest.h>

#include "protocol/messages.gen.hpp"
#include "protocol/traffic.hpp"

namespace limn::protocol {
namespace {

struct Refusal {
  const char* json;
  const char* code;
  const char* place;
};

const Refusal kRefusals[] = {
    {"[]", "bad-message", ""},
    {"\"ping\"", "bad-message", ""},
    {"{}", "bad-message", "/op"},
    {R"({"op":7,"seq":1})", "bad-message", "seq 1 /op"},
    {R"({"op":"dance","seq":1})", "unknown-op", "seq 1 /op"},
    {R"({"op":"pong","seq":1,"serverSeconds":1})", "unknown-op", "seq 1 /op"},
    {R"({"op":"ping"})", "bad-message", "/seq"},
    {R"({"op":"ping","seq":0})", "out-of-range", "/seq"},
    {R"({"op":"ping","seq":-1})", "out-of-range", "/seq"},
    {R"({"op":"ping","seq":1.5})", "bad-message", "/seq"},
    {R"({"op":"ping","seq":4294967296})", "out-of-range", "/seq"},
    {R"({"op":"ping","seq":"1"})", "bad-message", "/seq"},
    {R"({"op":"ping","seq":1,"extra":null})", "bad-message", "seq 1 /extra"},
    {R"({"op":"load","seq":1})", "bad-message", "seq 1 /uri"},
    {R"({"op":"load","seq":1,"uri":5})", "bad-message", "seq 1 /uri"},
    {R"({"op":"set","seq":12,"target":"material","material":1,"roughness":1.5})", "out-of-range", "seq 12 /roughness"},
    {R"({"op":"set","seq":12,"target":"material","material":1,"roughness":null})", "bad-message", "seq 12 /roughness"},
    {R"({"op":"set","seq":12,"target":"material","material":-1})", "out-of-range", "seq 12 /material"},
    {R"({"op":"set","seq":12,"target":"material","roughness":0.5})", "bad-message", "seq 12 /material"},
    {R"({"op":"set","seq":12,"target":"material","material":1,"intensity":3})", "bad-message", "seq 12 /intensity"},
    {R"({"op":"set","seq":12,"target":"material","material":1,"alphaMode":"glass"})", "out-of-range", "seq 12 /alphaMode"},
    {R"({"op":"set","seq":12,"target":"material","material":1,"baseColor":[1,1,1]})", "bad-message", "seq 12 /baseColor"},
    {R"({"op":"set","seq":12,"target":"material","material":1,"baseColor":[1,1,"1",1]})", "bad-message", "seq 12 /baseColor/2"},
    {R"({"op":"set","seq":12,"target":"material","material":1,"baseColor":[1,1,1,1.01]})", "out-of-range", "seq 12 /baseColor/3"},
    {R"({"op":"set","seq":12,"target":"sky"})", "out-of-range", "seq 12 /target"},
    {R"({"op":"set","seq":12})", "bad-message", "seq 12 /target"},
    {R"({"op":"set","seq":12,"target":"image","width":0,"height":600})", "out-of-range", "seq 12 /width"},
    {R"({"op":"set","seq":12,"target":"technique","parameters":{"a/b~":"4"}})", "bad-message", "seq 12 /parameters/a~1b~0"},
    {R"({"op":"batch","seq":12,"edits":[]})", "out-of-range", "seq 12 /edits"},
    {R"({"op":"batch","seq":12,"edits":{}})", "bad-message", "seq 12 /edits"},
    {R"({"op":"batch","seq":12,"edits":[7]})", "bad-message", "seq 12 /edits/0"},
    {R"({"op":"batch","seq":12,"edits":[{"target":"light","light":0},{"target":"material","material":0,"roughness":-0.1}]})",
     "out-of-range", "seq 12 /edits/1/roughness"},
    {R"({"op":"camera","seq":3,"eye":[0,0,1],"target":[0,0,0]})", "bad-message", "seq 3 /up"},
    {R"({"op":"camera","seq":3,"eye":[0,0,1],"target":[0,0,0],"up":[0,1,0],"yfov":0})", "out-of-range", "seq 3 /yfov"},
    {R"({"op":"camera","seq":3,"eye":[0,0,1e999],"target":[0,0,0],"up":[0,1,0]})", "out-of-range", "byte 38"},
    {R"({"op":"pick","seq":3,"x":16384,"y":0})", "out-of-range", "seq 3 /x"},
    {R"({"op":"ackFrame","seq":3,"frameId":1})", "bad-message", "seq 3 /dropped"},
    {R"({"op":"hello","seq":1,"version":1,"client":"c","encodings":["gif"]})", "out-of-range", "seq 1 /encodings/0"},
    {"{\"op\":\"load\",\"seq\":1,\"uri\":\"\xff\"}", "bad-message", "byte 28"},
};

TEST(ProtocolDecode, RefusesWithCodeAndPlace) {
  for (const Refusal& refusal : kRefusals) {
    const auto message = decodeClient(refusal.json);
    ASSERT_FALSE(message.ok()) << refusal.json;
    EXPECT_EQ(message.error().code, refusal.code) << refusal.json;
    EXPECT_EQ(message.error().place, refusal.place) << refusal.json;
    EXPECT_FALSE(message.error().message.empty());
    EXPECT_FALSE(checkTraffic(Direction::toServer, refusal.json).ok());
  }
}

TEST(ProtocolDecode, TellsTheSeqOfAMessageThatItRefuses) {
  uint32_t seq = 99;
  EXPECT_FALSE(decodeClient(R"({"op":"dance","seq":7})", &seq).ok());
  EXPECT_EQ(seq, 7u);
  EXPECT_FALSE(decodeClient(R"({"op":"ping","seq":"7"})", &seq).ok());
  EXPECT_EQ(seq, 0u);
}

TEST(ProtocolDecode, LongestMessageIsTakenAndOneByteMoreIsNot) {
  std::string text = R"({"op":"ping","seq":1})";
  text.resize(kMaxControlBytes, ' ');
  EXPECT_TRUE(decodeClient(text).ok());
  text.push_back(' ');
  EXPECT_EQ(decodeClient(text).error().code, "limit");
}

TEST(ProtocolDecode, LongestStringIsTakenAndOneByteMoreIsNot) {
  const std::string longest = encode(Load{1, std::string(4096, 'x')});
  EXPECT_TRUE(decodeClient(longest).ok());
  EXPECT_EQ(decodeClient(encode(Load{1, std::string(4097, 'x')})).error().code, "out-of-range");
}

TEST(ProtocolDecode, AbsentFieldsStayAbsent) {
  const auto message = decodeClient(R"({"op":"set","seq":1,"target":"material","material":3,"roughness":0})");
  ASSERT_TRUE(message.ok());
  const auto& edit = std::get<MaterialEdit>(std::get<SetMessage>(*message).edit);
  EXPECT_EQ(edit.material, 3u);
  EXPECT_EQ(edit.roughness, 0.0f);
  EXPECT_FALSE(edit.metallic.has_value());
}

TEST(ProtocolDecode, AClientPassesOverFieldsThatItDoesNotKnow) {
  const std::string_view text = R"({"op":"pong","seq":1,"serverSeconds":2,"mood":"fine"})";
  EXPECT_TRUE(decodeServer(text).ok());
  EXPECT_EQ(decodeServer(text, Strictness::strict).error().place, "seq 1 /mood");
  EXPECT_FALSE(checkTraffic(Direction::toClient, text).ok());
}

TEST(ProtocolDecode, ErrorCodesOutsideTheSchemaAreFoundInTraffic) {
  EXPECT_TRUE(checkTraffic(Direction::toClient, encode(ErrorMessage{1, std::string(kErrorBusy), "m", {}})).ok());
  EXPECT_FALSE(checkTraffic(Direction::toClient, encode(ErrorMessage{1, "oops", "m", {}})).ok());
}

TEST(ProtocolDecode, EditableFieldsAreThoseOfTheEdits) {
  const auto& targets = editableTargets();
  ASSERT_EQ(targets.front().target, "material");
  const auto& roughness = targets.front().fields[2];
  EXPECT_EQ(roughness.name, "roughness");
  EXPECT_EQ(roughness.kind, FieldKind::number);
  EXPECT_EQ(roughness.minimum, 0.0);
  EXPECT_EQ(roughness.maximum, 1.0);
  for (const EditableTarget& target : targets)
    for (const EditableField& field : target.fields) EXPECT_EQ(field.kind == FieldKind::choice, field.choices.has_value()) << field.name;
}

/// Bytes of good messages are changed, removed and doubled; whatever is still taken must survive being written and read.
TEST(ProtocolDecode, DamagedMessagesAreRefusedOrMeanWhatTheyAreWrittenAs) {
  const std::string good[] = {
      R"({"op":"batch","seq":31,"edits":[{"target":"image","width":640,"height":360},{"target":"resolve","exposure":-1.5e-3}]})",
      R"({"op":"camera","seq":3,"eye":[1e21,0.1,-1e-7],"target":[0.1,0,0],"up":[0,1,0],"yfov":0.8})",
      R"({"op":"set","seq":26,"target":"technique","technique":"path-tracing","parameters":{"maxBounces":8,"é":0.3}})"};
  std::mt19937 random(2024);
  const std::string_view alphabet = "{}[]\",:0123456789eE+-.\\utfn \xc3\xff";
  int taken = 0;
  for (int round = 0; round < 30000; ++round) {
    std::string text = good[random() % 3];
    for (uint32_t edits = 1 + random() % 3; edits > 0; --edits) {
      const size_t at = random() % text.size();
      if (const uint32_t kind = random() % 3; kind == 0) text[at] = alphabet[random() % alphabet.size()];
      else if (kind == 1) text.erase(at, 1 + random() % 4);
      else text.insert(at, std::string(text, random() % text.size(), random() % 6));
      if (text.empty()) text.push_back(' ');
    }
    const auto message = decodeClient(text);
    if (!message) continue;
    ++taken;
    const auto again = decodeClient(encode(*message));
    ASSERT_TRUE(again.ok()) << text << " " << again.error().text();
    ASSERT_EQ(*again, *message) << text;
  }
  EXPECT_GT(taken, 100);
}

}  // namespace
}  // namespace limn::protocol
