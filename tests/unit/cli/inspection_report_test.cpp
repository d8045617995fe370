// SPDX-License-Identifier: Apache-2.0
// Reports of `inspect`: names from foreign files, and the wording for users.
#include "cli/inspection_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "unit/cli/wrong_files.h"

namespace viewloom::test::inspection_report_test {
namespace {

using cli::InspectedFile;
using ::testing::HasSubstr;
using ::testing::Not;

bool hasControl(const std::string& text) {
  return std::ranges::any_of(
      text, [](unsigned char c) { return (c < 0x20 && c != '\n') || c == 0x7f || c >= 0x80; });
}

class InspectionReportTest : public WrongFilesTest {
 protected:
  // A file whose name and whose channel would drive a terminal.
  InspectedFile inspectedFile() const {
    const std::string path = file("a\033]0;title\a\xff.exr");
    const auto grey = [](int, int) { return 0.5F; };
    writeExr(path, kWidth, kHeight,
             {{"R", Imf::HALF, grey},
              {"G", Imf::HALF, grey},
              {"B", Imf::HALF, grey},
              {"x\033[2J\n\x9b.y", Imf::HALF, grey},
              {"Z", Imf::FLOAT, [](int x, int y) { return -roomAt(x, y); }}});
    const FrameFiles files{.manifest = {}, .deep = {}, .input = {.color = path}};
    InspectedFile inspected{.file = path};
    inspected.format = *cli::describeFormat(path);
    inspected.loaded = *cli::FrameLoader(cli::LoaderOptions()).load(files);
    inspected.sources = *inspect::inspectFrame(inspected.loaded.frame);
    return inspected;
  }
};

TEST_F(InspectionReportTest, printsNoControlCharacters) {
  const std::string text = reportText(inspectedFile());
  EXPECT_FALSE(hasControl(text)) << text;
  EXPECT_THAT(text, HasSubstr("\\x1b[2J\\x0a\\x9b.y (half)"));
  EXPECT_THAT(text, HasSubstr("a\\x1b]0;title\\x07\\xff.exr"));
}

TEST_F(InspectionReportTest, isJsonWhateverTheNamesHold) {
  const std::string text = cli::jsonText(reportJson(inspectedFile()));
  EXPECT_FALSE(hasControl(text)) << text;
  EXPECT_TRUE(nlohmann::json::accept(text));
}

TEST_F(InspectionReportTest, speaksInTheWordsOfUsers) {
  const std::string text = reportText(inspectedFile());
  EXPECT_THAT(text, HasSubstr("RGBA, floats of 16 bits"));
  EXPECT_THAT(text, HasSubstr("floats of 32 bits: metres along the view axis"));
  for (const char* word : {"scanlineimage", "rgba16f", "depth_f32"}) {
    EXPECT_THAT(text, Not(HasSubstr(word)));
  }
}

}  // namespace
}  // namespace viewloom::test::inspection_report_test
