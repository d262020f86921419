#include "server/arguments.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limn {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

CommandSpec exampleSpec() {
  return {"prog",
          "Does things.",
          {"IN", "MORE..."},
          {{"output", "FILE", "where to", false, "", true},
           {"set", "name=value", "a parameter", true},
           {"time", "SECONDS", "how long", false, "stop"},
           {"steps", "N", "how many", false, "stop"},
           {"json", "", "as JSON"}}};
}

Result<Arguments> parse(const std::vector<std::string>& words) { return Arguments::parse(exampleSpec(), words); }

TEST(Arguments, FlagsAndPositionalsMayMix) {
  const Result<Arguments> arguments =
      parse({"a", "--output", "o.exr", "--set=x=1", "b", "--json", "--set", "y=-2", "--", "--not-a-flag", "-"});
  ASSERT_TRUE(arguments.ok()) << arguments.error().text();
  EXPECT_THAT(arguments->positionals(), ElementsAre("a", "b", "--not-a-flag", "-"));
  EXPECT_EQ(arguments->text("output"), "o.exr");
  EXPECT_THAT(arguments->all("set"), ElementsAre("x=1", "y=-2"));
  EXPECT_TRUE(arguments->has("json"));
  EXPECT_FALSE(arguments->has("time"));
  EXPECT_EQ(arguments->text("time", "9"), "9");
}

struct Refusal {
  std::vector<std::string> words;
  std::string says;
};

class ArgumentsRefuse : public ::testing::TestWithParam<Refusal> {};

TEST_P(ArgumentsRefuse, AsUsageErrorThatSaysWhy) {
  const Result<Arguments> arguments = parse(GetParam().words);
  ASSERT_FALSE(arguments.ok());
  EXPECT_EQ(arguments.error().code, "usage");
  EXPECT_THAT(arguments.error().text(), HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    Table, ArgumentsRefuse,
    ::testing::Values(Refusal{{"a", "b", "--output", "o", "--fast"}, "unknown flag '--fast'"},
                      Refusal{{"a", "b", "--output", "o", "--fast=1"}, "unknown flag '--fast'"},
                      Refusal{{"a", "b", "--output", "o", "-j"}, "unknown flag '-j'"},
                      Refusal{{"a", "b", "--output", "o", "--outpu", "p"}, "unknown flag '--outpu'"},
                      Refusal{{"a", "b"}, "missing --output FILE"}, Refusal{{"--output", "o", "a"}, "missing MORE..."},
                      Refusal{{"--output", "o"}, "missing IN"}, Refusal{{"a", "b", "--output"}, "--output needs FILE"},
                      Refusal{{"a", "b", "--output", "--json"}, "--output needs FILE"},
                      Refusal{{"a", "b", "--output", "o", "--output", "p"}, "--output is given twice"},
                      Refusal{{"a", "b", "--output", "o", "--json=yes"}, "--json takes no value"},
                      Refusal{{"a", "b", "--output", "o", "--time", "1", "--steps", "2"}, "exclude each other"}));

TEST(Arguments, TooManyPositionalsAreRefused) {
  const CommandSpec spec{"prog", "", {"IN"}, {}};
  const std::vector<std::string> words = {"a", "b"};
  const Result<Arguments> arguments = Arguments::parse(spec, words);
  ASSERT_FALSE(arguments.ok());
  EXPECT_THAT(arguments.error().text(), HasSubstr("unexpected argument 'b'"));
}

TEST(Arguments, HelpWinsOverEverythingElse) {
  const Result<Arguments> arguments = parse({"--nonsense", "--help"});
  ASSERT_TRUE(arguments.ok());
  EXPECT_TRUE(arguments->help());
}

TEST(Arguments, HelpNamesEveryFlagWithItsValueAndText) {
  const CommandSpec spec = exampleSpec();
  const std::string text = helpText(spec);
  for (const Flag& flag : spec.flags) {
    EXPECT_THAT(text, HasSubstr("--" + flag.name + (flag.value.empty() ? "" : " " + flag.value)));
    EXPECT_THAT(text, HasSubstr(flag.help));
  }
  EXPECT_THAT(text, HasSubstr("usage: prog IN MORE... --output FILE [flags]"));
  EXPECT_THAT(text, HasSubstr("--help"));
}

TEST(Arguments, NumbersAreWholeAndInRange) {
  const auto time = [](const std::string& value) {
    return parse({"a", "b", "--output", "o", "--time", value})->real("time", 1.0, 0.0, 100.0);
  };
  EXPECT_EQ(time("0.25").value(), 0.25);
  EXPECT_EQ(time("1e2").value(), 100.0);
  for (const char* bad : {"", "x", "1x", "1 ", " 1", "nan", "inf", "-1", "100.1", "0x10", "1,5"})
    EXPECT_FALSE(time(bad).ok()) << "'" << bad << "'";
  const auto steps = [](const std::string& value) {
    return parse({"a", "b", "--output", "o", "--steps", value})->integer("steps", 1, 2, 1000);
  };
  EXPECT_EQ(steps("2").value(), 2u);
  EXPECT_EQ(steps("1000").value(), 1000u);
  for (const char* bad : {"", "1", "1001", "-5", "+5", "5.0", "99999999999999999999999"})
    EXPECT_FALSE(steps(bad).ok()) << "'" << bad << "'";
  EXPECT_EQ(parse({"a", "b", "--output", "o"})->integer("steps", 7, 2, 1000).value(), 7u) << "the fallback";
}

TEST(Arguments, PixelSizes) {
  EXPECT_EQ(parsePixelSize("640x480")->width, 640u);
  EXPECT_EQ(parsePixelSize("640x480")->height, 480u);
  EXPECT_EQ(parsePixelSize("65536x1")->width, 65536u);
  for (const char* bad : {"", "640", "640x", "x480", "0x480", "640x65537", "640X480", "640x480x1", "-1x5", "6e2x1"})
    EXPECT_FALSE(parsePixelSize(bad).ok()) << bad;
}

TEST(Arguments, ListsKeepEmptyItemsOnlyWhereAsked) {
  EXPECT_THAT(splitList("a,,b", ','), ElementsAre("a", "", "b"));
  EXPECT_THAT(splitList("", ','), ElementsAre(""));
  EXPECT_THAT(parse({"a", "b", "--output", "x,,y,"})->list("output"), ElementsAre("x", "y"));
}

TEST(Arguments, ExitCodesFollowTheErrorsCode) {
  EXPECT_EQ(reportFailure("t", {"usage", "u", ""}), 64);
  EXPECT_EQ(reportFailure("t", {"device-lost", "d", ""}), 75);
  EXPECT_EQ(reportFailure("t", {"bad-file", "b", "f"}), 1);
}

}  // namespace
}  // namespace limn
