#include "server/limn/send_script.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limn {
namespace {

using ::testing::HasSubstr;

TEST(SendScript, ReadsOneMessageALineAndPassesOverBlankOnes) {
  const Result<std::vector<ScriptMessage>> script =
      parseScript("{\"op\":\"ping\"}\n\n \t\r\n{\"op\":\"wait\",\"steps\":4,\"seq\":17}\r\n{ \"op\":\"describe\"}", "s");
  ASSERT_TRUE(script.ok()) << script.error().text();
  ASSERT_EQ(script->size(), 3u);
  EXPECT_EQ((*script)[0].line, 1u);
  EXPECT_EQ(std::get<protocol::Ping>((*script)[0].message).seq, 0u) << "the client numbers it";
  EXPECT_EQ((*script)[1].line, 4u);
  EXPECT_EQ((*script)[1].place, "s:4");
  EXPECT_EQ(std::get<protocol::Wait>((*script)[1].message).seq, 0u) << "the client numbers this one, too";
  EXPECT_EQ(std::get<protocol::Wait>((*script)[1].message).steps, 4u);
  EXPECT_TRUE(std::holds_alternative<protocol::Describe>((*script)[2].message));
}

TEST(SendScript, EditsAreToldFromTheRest) {
  const auto edit = [](const std::string& line) { return isEdit(parseScript(line, "s")->at(0).message); };
  EXPECT_TRUE(edit(R"({"op":"set","target":"material","material":0,"roughness":0.5})"));
  EXPECT_TRUE(edit(R"({"op":"camera","eye":[0,0,1],"target":[0,0,0],"up":[0,1,0]})"));
  EXPECT_TRUE(edit(R"({"op":"batch","edits":[{"target":"resolve","exposure":1}]})"));
  EXPECT_FALSE(edit(R"({"op":"ping"})"));
  EXPECT_FALSE(edit(R"({"op":"save"})"));
}

TEST(SendScript, MistakesAreFoundBeforeAnythingIsSentAndNameTheLine) {
  const auto refusal = [](const std::string& text) {
    const Result<std::vector<ScriptMessage>> script = parseScript(text, "edits.jsonl");
    EXPECT_FALSE(script.ok()) << text;
    return script.ok() ? Error{} : script.error();
  };
  EXPECT_EQ(refusal("{\"op\":\"ping\"}\nnot json").code, "bad-message");
  EXPECT_THAT(refusal("{\"op\":\"ping\"}\nnot json").place, HasSubstr("edits.jsonl:2"));
  EXPECT_THAT(refusal(R"({"op":"ping","seq":-1})").place, HasSubstr("edits.jsonl:1 /seq"));
  EXPECT_EQ(refusal("[1]").code, "bad-message");
  EXPECT_EQ(refusal("{}").code, "bad-message");
  EXPECT_EQ(refusal(R"({"op":"paint"})").code, "unknown-op");
  EXPECT_EQ(refusal(R"({"op":"ping","colour":1})").code, "bad-message");
  const Error range = refusal(R"({"op":"set","target":"material","material":0,"roughness":2})");
  EXPECT_EQ(range.code, "out-of-range");
  EXPECT_THAT(range.place, HasSubstr("/roughness"));
}

TEST(SendScript, AnAbsentScriptIsAnIoError) { EXPECT_EQ(readScript("absent.jsonl").error().code, "io"); }

}  // namespace
}  // namespace limn
