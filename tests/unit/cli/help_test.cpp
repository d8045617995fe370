// SPDX-License-Identifier: Apache-2.0
// Rules that the help of every command of `viewloom` keeps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "offline/offline_commands.h"
#include "usage/command_line.h"

namespace viewloom::cli {
namespace {

using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

constexpr size_t kWordsMax = 30;
constexpr size_t kColumnsMax = 100;
constexpr size_t kTableColumnsMax = 72;  // behind the column in which descriptions begin

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// Sentences, and parts of them that a semicolon separates.
std::vector<std::string> sentencesOf(const std::string& text) {
  const std::regex end("\\. |; |\n");
  return {std::sregex_token_iterator(text.begin(), text.end(), end, -1),
          std::sregex_token_iterator()};
}

size_t wordCount(const std::string& sentence) {
  std::istringstream in(sentence);
  size_t count = 0;
  for (std::string word; in >> word;) ++count;
  return count;
}

void checkDescription(const std::string& text, const std::string& of) {
  SCOPED_TRACE(of + ": " + text);
  ASSERT_FALSE(text.empty());
  EXPECT_TRUE(text[0] >= 'A' && text[0] <= 'Z') << "begins with a small letter";
  EXPECT_FALSE(std::regex_search(text, std::regex("^(Of|Who|What|That|As|Where)\\b")))
      << "begins with a clause, not with a thing or an act";
  EXPECT_FALSE(text.ends_with('.')) << "the default or other options may follow";
  EXPECT_FALSE(std::regex_search(text, std::regex("[^0-9] px\\b"))) << "pixel, in prose";
  EXPECT_THAT(text, Not(HasSubstr("["))) << "a default belongs to defaultText()";
  for (const std::string& sentence : sentencesOf(text)) {
    EXPECT_LE(wordCount(sentence), kWordsMax) << sentence;
  }
  const std::vector<std::string> lines = linesOf(text);
  for (size_t line = 1; line < lines.size(); ++line) {
    EXPECT_LE(lines[line].size(), kTableColumnsMax) << lines[line];
  }
}

class Help : public testing::Test {
 protected:
  Help() {
    for (NamedCommand& command : addOfflineCommands(app_)) commands_.push_back(std::move(command));
  }

  const usage::CommandLine app_{"Test", "viewloom"};
  std::vector<NamedCommand> commands_ = addCommands(app_);
};

TEST_F(Help, explainsEveryOptionAndNamesItsValue) {
  for (const NamedCommand& command : commands_) {
    for (const usage::Option& option : command.syntax.options()) {
      if (!option.isShown()) continue;
      const std::string name = command.syntax.name() + " " + option.name();
      // Positions are given as the line of JSON that a file holds.
      if (option.name() != "--eyes") checkDescription(option.help(), name);
      EXPECT_THAT(option.valueName(), Not(AnyOf("TEXT", "UINT", "INT", "FLOAT"))) << name;
    }
  }
}

TEST_F(Help, showsExamplesAndFitsOnAScreen) {
  for (const NamedCommand& command : commands_) {
    const std::string help = command.syntax.help();
    const std::string name = command.syntax.name();
    checkDescription(linesOf(help).at(0), name);
    if (linesOf(help).at(0).ends_with("(not in this build)")) continue;
    EXPECT_THAT(help, HasSubstr("Examples:\n  viewloom " + name));
    for (const std::string& line : linesOf(help)) {
      if (line.starts_with("  viewloom ")) continue;
      EXPECT_LE(line.size(), kColumnsMax) << line;
    }
  }
}

TEST_F(Help, saysTheDefaultAndOtherOptionsInParentheses) {
  usage::CommandLine app("Test", "test");
  double rate_hz = 0;
  std::string file = "a.txt";
  const usage::Option out = app.add("--out", file, "File to write").valueName("FILE").showDefault();
  app.add("--fps,--rate", rate_hz, "Frames per second\nslow  1")
      .valueName("HZ")
      .defaultText("15, replay as recorded")
      .needs(out);
  EXPECT_THAT(app.help(),
              HasSubstr("\n  --out FILE                File to write (default a.txt)\n"));
  EXPECT_THAT(app.help(),
              HasSubstr("\n  --fps, --rate HZ          Frames per second (default 15, replay as "
                        "recorded; needs --out)\n" +
                        std::string(28, ' ') + "slow  1\n"));
}

}  // namespace
}  // namespace viewloom::cli
