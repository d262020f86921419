// Numbers and strings against what JavaScript's JSON.stringify writes.
#include <bit>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "protocol/json_value.hpp"
#include "protocol/json_writer.hpp"
#include "protocol/utf8.hpp"

namespace limn::protocol {
namespace {

struct NumberCase {
  double value;
  const char* text;
};

TEST(ProtocolJson, DoublesAreWrittenAsJavaScriptWritesThem) {
  const NumberCase cases[] = {{0.0, "0"}, {-0.0, "0"}, {1.0, "1"}, {-1.0, "-1"}, {0.1, "0.1"}, {0.1 + 0.2, "0.30000000000000004"},
                              {1e-7, "1e-7"}, {1e-6, "0.000001"}, {1.5e-6, "0.0000015"}, {1e-5, "0.00001"},
                              {123456789012345680000.0, "123456789012345680000"}, {1e20, "100000000000000000000"},
                              {1e21, "1e+21"}, {1.5e21, "1.5e+21"}, {5e-324, "5e-324"},
                              {1.7976931348623157e308, "1.7976931348623157e+308"}, {4294967296.0, "4294967296"},
                              {9007199254740991.0, "9007199254740991"}, {1.0 / 3.0, "0.3333333333333333"}, {1.23e-18, "1.23e-18"},
                              {0.000001234, "0.000001234"}, {-1234.5, "-1234.5"}};
  for (const NumberCase& c : cases) EXPECT_EQ(javascriptNumber(c.value), c.text);
}

TEST(ProtocolJson, BitPatternsOfALinearGeneratorAreWrittenAsNodeWritesThem) {
  const std::pair<uint64_t, const char*> cases[] = {
      {0x1c0d57f10c894254, "1.4830122828920016e-173"}, {0x43f04a6ece53d613, "18781959765316678000"},
      {0xe2b8410510668fa6, "-3.575532127436644e+167"}, {0xd5f2e30a9e501b7d, "-1.0829258728928171e+106"},
      {0x8f7b1bac9609eaf7, "-4.262874002980358e-234"}, {0x302bd02b522a861b, "1.2009957333271821e-76"},
      {0x5fe48bdeead11f23, "8.60880578948587e+153"},   {0x5cd158ba16a76b0d, "1.29107691235244e+139"},
      {0x7727df42b81c598, "8.54570675525937e-273"},    {0x8ade8c37577c5b91, "-2.5430944865444634e-256"}};
  for (const auto& [bits, text] : cases) EXPECT_EQ(javascriptNumber(std::bit_cast<double>(bits)), text);
}

TEST(ProtocolJson, FloatsTakeTheFewestDigitsThatGiveTheSameFloat) {
  EXPECT_EQ(javascriptNumber(0.1f), "0.1");
  EXPECT_EQ(javascriptNumber(1e-7f), "1e-7");
  EXPECT_EQ(javascriptNumber(16777216.0f), "16777216");
  EXPECT_EQ(javascriptNumber(std::numeric_limits<float>::max()), "3.4028235e+38");
  EXPECT_EQ(javascriptNumber(std::numeric_limits<float>::denorm_min()), "1e-45");
}

TEST(ProtocolJson, NumbersThatAreNotFiniteBecomeNull) {
  EXPECT_EQ(javascriptNumber(std::numeric_limits<double>::infinity()), "null");
  EXPECT_EQ(javascriptNumber(std::numeric_limits<float>::quiet_NaN()), "null");
}

std::string quoted(std::string_view text) {
  JsonWriter writer;
  writer.value(text);
  return writer.take();
}

TEST(ProtocolJson, StringsAreEscapedAsJavaScriptEscapesThem) {
  EXPECT_EQ(quoted("a\"b\\c/d"), R"("a\"b\\c/d")");
  EXPECT_EQ(quoted("\b\f\n\r\t\v"), R"("\b\f\n\r\t\u000b")");
  EXPECT_EQ(quoted(std::string_view("\0\x1f\x7f", 3)), "\"\\u0000\\u001f\x7f\"");
  EXPECT_EQ(quoted("é€😀\u2028"), "\"é€😀\u2028\"");
}

TEST(ProtocolJson, BytesThatAreNotUtf8BecomeTheReplacementCharacter) {
  EXPECT_EQ(quoted("a\xff" "b"), "\"a\xEF\xBF\xBD" "b\"");
  EXPECT_EQ(quoted("\xe2\x82"), "\"\xEF\xBF\xBD\xEF\xBF\xBD\"");
}

TEST(ProtocolJson, WellFormedUtf8IsTold) {
  for (const char* good : {"", "plain", "é", "€", "😀", "\xed\x9f\xbf", "\xf4\x8f\xbf\xbf"}) EXPECT_TRUE(isUtf8(good)) << good;
  const char* bad[] = {"\x80", "\xc0\xaf", "\xc1\xbf", "\xe0\x80\x80", "\xed\xa0\x80", "\xf0\x80\x80\x80", "\xf4\x90\x80\x80",
                       "\xf5\x80\x80\x80", "\xe2\x82", "\xc3"};
  for (const char* text : bad) EXPECT_FALSE(isUtf8(text));
}

TEST(ProtocolJson, TextThatIsNoJsonIsRefusedWithTheByte) {
  for (const char* text : {"", " ", "{", "{\"a\":}", "[1,]", "{\"a\" 1}", "01", "+1", "1.", ".5", "nul", "\"\\x\"", "\"a\nb\"",
                           "[1] 2", "{'a':1}", "NaN", "\"\\ud800\"", "\"\xff\"", "\"\xed\xa0\x80\"", "\xEF\xBB\xBF[]"}) {
    const auto parsed = parseJson(text, 16);
    ASSERT_FALSE(parsed.ok()) << text;
    EXPECT_EQ(parsed.error().code, "bad-message") << text;
    EXPECT_TRUE(parsed.error().place.starts_with("byte ")) << text;
  }
}

TEST(ProtocolJson, NestingIsLimitedExactly) {
  const auto nested = [](size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  EXPECT_TRUE(parseJson(nested(16), 16).ok());
  EXPECT_EQ(parseJson(nested(17), 16).error().code, "limit");
  EXPECT_EQ(parseJson(std::string(1 << 20, '['), 16).error().code, "limit");
}

TEST(ProtocolJson, AMemberMayNotAppearTwice) {
  EXPECT_EQ(parseJson(R"({"a":1,"b":{"a":1},"a":2})", 16).error().code, "bad-message");
  EXPECT_TRUE(parseJson(R"({"a":1,"b":{"a":1}})", 16).ok());
}

TEST(ProtocolJson, NumbersBeyondDoubleAreRefused) {
  EXPECT_EQ(parseJson("[1e309]", 16).error().code, "out-of-range");
  EXPECT_EQ(*parseJson("1e-400", 16)->number(), 0.0);
  EXPECT_EQ(*parseJson("123456789012345678901234567890", 16)->number(), 123456789012345678901234567890.0);
}

}  // namespace
}  // namespace limn::protocol
