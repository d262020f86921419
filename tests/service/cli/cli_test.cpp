#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "protocol/json_value.hpp"
#include "renderer/film/exr.hpp"
#include "server/limn/commands.hpp"
#include "tests/service/cli/run_program.hpp"

namespace limn {
namespace {

using ::testing::HasSubstr;
using test::ProgramRun;

ProgramRun limnProgram(const std::vector<std::string>& words) { return test::runProgram(LIMN_PROGRAM, words); }

std::vector<std::string> commandWords() {
  std::vector<std::string> words;
  for (const Command& command : allCommands()) words.push_back(command.spec.name.substr(std::string("limn ").size()));
  return words;
}

void expectOneLine(const std::string& text) {
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
  EXPECT_TRUE(text.ends_with("\n")) << text;
}

FilmImage constantFilm(float value, const std::string& range) {
  FilmImage image{16, 8, {{"beauty", 3, std::vector<float>(16 * 8 * 3, value)}}, {}};
  image.layers.push_back({"samples", 1, std::vector<float>(16 * 8, 4.0f)});
  image.metadata = {{"limn:samples", range}, {"limn:sceneHash", "1"}, {"limn:seed", "0"}, {"limn:technique", "t"}};
  return image;
}

class Limn : public ::testing::Test {
 protected:
  std::string film(const std::string& name, float value, const std::string& range = "0:4") {
    const std::string file = m_scratch.file(name);
    EXPECT_TRUE(writeExr(file, constantFilm(value, range)).ok());
    return file;
  }
  std::string scratch(const std::string& name) const { return m_scratch.file(name); }

 private:
  test::ScratchDirectory m_scratch;
};

TEST_F(Limn, HelpListsEveryCommandAndEachCommandsHelpEveryFlag) {
  const ProgramRun overview = limnProgram({"--help"});
  EXPECT_EQ(overview.exitCode, 0);
  EXPECT_EQ(overview.err, "");
  for (const Command& command : allCommands()) {
    const std::string word = command.spec.name.substr(5);
    EXPECT_THAT(overview.out, HasSubstr(word));
    const ProgramRun help = limnProgram({word, "--help"});
    EXPECT_EQ(help.exitCode, 0);
    EXPECT_EQ(help.out, helpText(command.spec));
  }
}

TEST_F(Limn, UnknownFlagsOfEveryCommandExit64WithOneLine) {
  for (const std::string& word : commandWords()) {
    const ProgramRun run = limnProgram({word, "--no-such-flag"});
    EXPECT_EQ(run.exitCode, 64) << word;
    EXPECT_EQ(run.out, "") << word;
    EXPECT_THAT(run.err, HasSubstr("limn " + word + ": unknown flag '--no-such-flag'"));
    expectOneLine(run.err);
  }
}

TEST_F(Limn, UnknownCommandsExit64WithOneLine) {
  for (const std::vector<std::string>& words : {std::vector<std::string>{}, {"paint"}, {"--fast"}}) {
    const ProgramRun run = limnProgram(words);
    EXPECT_EQ(run.exitCode, 64);
    expectOneLine(run.err);
  }
}

TEST_F(Limn, AFileThatIsNotThereExits1WithOneLineThatNamesIt) {
  const ProgramRun compare = limnProgram({"compare", "absent.exr", film("a.exr", 1.0f)});
  EXPECT_EQ(compare.exitCode, 1);
  EXPECT_THAT(compare.err, HasSubstr("absent.exr"));
  expectOneLine(compare.err);
  const ProgramRun merge = limnProgram({"merge", "absent.exr", "--output", scratch("out.exr")});
  EXPECT_EQ(merge.exitCode, 1);
  expectOneLine(merge.err);
}

TEST_F(Limn, AnOutputThatCannotBeWrittenIsToldBeforeTheInputsAreRead) {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"merge", "absent.exr", "--output", "/proc/out.exr"},
                                             {"compare", "absent.exr", "absent.exr", "--heatmap", "/proc/out.png"},
                                             {"render", "absent.glb", "--output", "/proc/out.exr"}}) {
    const ProgramRun run = limnProgram(words);
    EXPECT_EQ(run.exitCode, 1);
    EXPECT_THAT(run.err, HasSubstr("limn " + words[0] + ": /proc/out."));
    EXPECT_THAT(run.err, HasSubstr("cannot be written"));
    expectOneLine(run.err);
  }
}

TEST_F(Limn, CompareTellsTheErrorAsJson) {
  const std::string a = film("a.exr", 3.0f), r = film("r.exr", 2.0f);
  const ProgramRun run = limnProgram({"compare", a, r, "--json", "--low"});
  ASSERT_EQ(run.exitCode, 0) << run.err;
  const Result<protocol::JsonValue> json = protocol::parseJson(run.out, 8);
  ASSERT_TRUE(json.ok()) << run.out;
  EXPECT_NEAR(*json->find("relmse")->number(), 1.0 / 4.04, 1e-9);
  EXPECT_NEAR(*json->find("relmseAll")->number(), 1.0 / 4.04, 1e-9);
  EXPECT_NEAR(*json->find("rmse")->number(), 1.0, 1e-9);
  EXPECT_NEAR(*json->find("low")->find("relmse")->number(), 1.0 / 4.04, 1e-9);
}

TEST_F(Limn, CompareSaysRelMseWithAndWithoutTheDiscardInText) {
  const ProgramRun run = limnProgram({"compare", film("a.exr", 3.0f), film("r.exr", 2.0f), "--metric", "relmse"});
  ASSERT_EQ(run.exitCode, 0) << run.err;
  EXPECT_EQ(run.out, "relmse         0.247525\nrelmseAll      0.247525\n");
}

TEST_F(Limn, CompareUsesHalves) {
  const std::string a = film("a.exr", 3.0f), r = film("r.exr", 2.0f);
  const std::string low = film("low.exr", 1.0f), high = film("high.exr", 3.0f);
  const ProgramRun run = limnProgram({"compare", a, r, "--halves", low + "," + high, "--json"});
  ASSERT_EQ(run.exitCode, 0) << run.err;
  EXPECT_NEAR(*protocol::parseJson(run.out, 8)->find("relmse")->number(), 0.0, 1e-12) << "(3-1)(3-3)";
  EXPECT_EQ(limnProgram({"compare", a, r, "--halves", low}).exitCode, 64);
}

TEST_F(Limn, CompareWritesAHeatmap) {
  const std::string heatmap = scratch("heat.png");
  const ProgramRun run = limnProgram({"compare", film("a.exr", 3.0f), film("r.exr", 2.0f), "--heatmap", heatmap});
  ASSERT_EQ(run.exitCode, 0) << run.err;
  EXPECT_TRUE(test::readText(heatmap).starts_with("\x89PNG"));
}

TEST_F(Limn, CompareRefusesUnknownMetricsAndOtherSizes) {
  const std::string a = film("a.exr", 3.0f);
  EXPECT_EQ(limnProgram({"compare", a, a, "--metric", "ssim"}).exitCode, 64);
  FilmImage small{2, 2, {{"beauty", 3, std::vector<float>(12, 1.0f)}}, {}};
  ASSERT_TRUE(writeExr(scratch("small.exr"), small).ok());
  const ProgramRun run = limnProgram({"compare", a, scratch("small.exr")});
  EXPECT_EQ(run.exitCode, 1);
  EXPECT_THAT(run.err, HasSubstr("16x8 against a reference of 2x2"));
}

TEST_F(Limn, OutputThatDoesNotArriveIsAFailure) {
  const std::string a = film("a.exr", 3.0f);
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"--help"}, {"info", "--help"}, {"compare", a, a}, {"merge", a, "--output", scratch("whole.exr")}}) {
    std::vector<std::string> whole = {"-c", "exec \"$0\" \"$@\" >/dev/full", LIMN_PROGRAM};
    whole.insert(whole.end(), words.begin(), words.end());
    const ProgramRun run = test::runProgram("/bin/sh", whole);
    EXPECT_EQ(run.exitCode, 1) << words[0];
    EXPECT_THAT(run.err, HasSubstr(": standard output cannot be written"));
    expectOneLine(run.err);
  }
}

TEST_F(Limn, MergeWritesTheMeanOfTheParts) {
  const std::string whole = scratch("whole.exr");
  const std::string second = film("b.exr", 5.0f, "4:8"), first = film("a.exr", 1.0f, "0:4");
  const ProgramRun run = limnProgram({"merge", second, first, "--output", whole});
  ASSERT_EQ(run.exitCode, 0) << run.err;
  const Result<FilmImage> merged = readExr(whole);
  ASSERT_TRUE(merged.ok());
  EXPECT_EQ(merged->find("beauty")->data[7], 3.0f);
  EXPECT_EQ(merged->find("samples")->data[7], 8.0f);
}

TEST_F(Limn, MergeRefusesGapsAndLeavesNoOutput) {
  const std::string whole = scratch("whole.exr");
  const std::string first = film("a.exr", 1.0f, "0:4"), second = film("b.exr", 5.0f, "5:8");
  const ProgramRun run = limnProgram({"merge", first, second, "--output", whole});
  EXPECT_EQ(run.exitCode, 1);
  EXPECT_THAT(run.err, HasSubstr("samples 4:5 are in no part"));
  expectOneLine(run.err);
  EXPECT_FALSE(std::filesystem::exists(whole));
  EXPECT_EQ(limnProgram({"merge", first}).exitCode, 64);
  EXPECT_EQ(limnProgram({"merge", first, "--output", scratch("x.png")}).exitCode, 64);
}

}  // namespace
}  // namespace limn
