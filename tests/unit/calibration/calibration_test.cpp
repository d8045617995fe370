// SPDX-License-Identifier: Apache-2.0
#include "calibration/calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "base/thread_time.h"
#include "unit/calibration/device_files.h"

namespace viewloom::calibration_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Calibration, readsThePortraitsFile) {
  const absl::StatusOr<Calibration> read = parseCalibration(kPortraitFile);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->pitch, 52.594383239746094);
  EXPECT_EQ(read->slope, -7.21152925491333);
  EXPECT_EQ(read->center, 0.40277382731437683);
  EXPECT_EQ(read->view_cone_deg, 40);
  EXPECT_EQ(read->dpi, 324);
  EXPECT_EQ(read->screen_px, (SizePx{1536, 2048}));
  EXPECT_TRUE(read->inv_view);
  EXPECT_FALSE(read->flip_x || read->flip_y || read->flip_subpixels);
  EXPECT_EQ(read->cell_pattern_mode, 0u);
  EXPECT_THAT(read->cells, IsEmpty());
  EXPECT_EQ(read->serial, "LKG-PORT-");
  EXPECT_EQ(read->config_version, "3.0");
}

TEST(Calibration, readsTheCellsOfTheThirdGeneration) {
  const absl::StatusOr<Calibration> read = parseCalibration(kThirdGenerationFile);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->screen_px, (SizePx{3840, 2160}));
  EXPECT_EQ(read->cell_pattern_mode, 2u);
  ASSERT_EQ(read->cells.size(), 2u);
  EXPECT_EQ(read->cells[0], (SubpixelCell{{-0.31, 0.25}, {0.28, 0.25}, {0, -0.25}}));
  EXPECT_EQ(read->cells[1], (SubpixelCell{{-0.31, -0.25}, {0.28, -0.25}, {0, 0.25}}));
  EXPECT_TRUE(read->inv_view) << "no public player shows views in any other order";
}

TEST(Calibration, readsPlainNumbers) {
  const absl::StatusOr<Calibration> read = parseCalibration(
      R"({"pitch":47.5,"slope":-5.48,"center":0.37,"DPI":338,"screenW":2560,"screenH":1600,
          "invView":0,"flipImageX":1,"flipImageY":1,"flipSubp":1})");
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->pitch, 47.5);
  EXPECT_EQ(read->screen_px, (SizePx{2560, 1600}));
  EXPECT_FALSE(read->inv_view);
  EXPECT_TRUE(read->flip_x && read->flip_y && read->flip_subpixels);
}

TEST(Calibration, readsFilesOfTheFirstGeneration) {
  const absl::StatusOr<Calibration> read = parseCalibration(
      R"({"configVersion":"1.0","serial":"00297","pitch":{"value":49.81804275512695},
          "slope":{"value":5.044347763061523},"center":{"value":0.176902174949646},
          "fringe":{"value":0.0},"viewCone":{"value":40.0},"DPI":{"value":338.0},
          "screenW":{"value":2560.0},"screenH":{"value":1600.0}})");
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->serial, "00297");
  EXPECT_EQ(read->config_version, "1.0");
  EXPECT_THAT(read->cells, IsEmpty());
}

TEST(Calibration, readsTheModeInLowerCase) {
  const absl::StatusOr<Calibration> read =
      parseCalibration(edited(kThirdGenerationFile, "CellPatternMode", "cellPatternMode"));
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->cell_pattern_mode, 2u);
}

TEST(Calibration, readsTheFileAsATextInJson) {
  // Bridge passes the file as a JSON string, with escaped quotes.
  std::string text = "\"";
  for (const char character : kPortraitFile) {
    if (character == '"') text += '\\';
    text += character;
  }
  const absl::StatusOr<Calibration> read = parseCalibration(text + "\"");
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(*read, *parseCalibration(kPortraitFile));
}

struct Broken {
  std::string file;
  std::string key;
  std::string said;
};

void expectRefused(const Broken& broken) {
  SCOPED_TRACE(broken.file);
  const absl::StatusOr<Calibration> read = parseCalibration(broken.file);
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(fieldOf(read.status()), broken.key);
  EXPECT_THAT(std::string(read.status().message()),
              AllOf(HasSubstr(broken.said), HasSubstr("copy LKG_calibration/visual.json")));
}

TEST(Calibration, refusesWrongNumbersAndNamesTheirKey) {
  const auto portrait = [](const char* from, const std::string& to) {
    return edited(kPortraitFile, from, to);
  };
  const std::vector<Broken> files = {
      {portrait("\"pitch\"", "\"patch\""), "pitch", "is missing; accepted is a number"},
      {portrait("\"screenH\"", "\"screenh\""), "screenH", "is missing; accepted is a whole number"},
      {portrait("{\"value\":324}", "\"324\""), "DPI", "is \"324\"; accepted is a number"},
      {portrait("{\"value\":324}", "{\"value\":true}"), "DPI", "is true"},
      {portrait("{\"value\":324}", "{\"value\":[324]}"), "DPI", "is [324]"},
      {portrait("{\"value\":324}", "{\"worth\":324}"), "DPI", R"(is {"worth":324})"},
      {portrait("{\"value\":324}", "null"), "DPI", "is null"},
      {portrait("{\"value\":324}", "0"), "DPI", "is 0; accepted is a number 1..100000"},
      {portrait("52.594383239746094", "0"), "pitch", "is 0; accepted is a number other"},
      {portrait("52.594383239746094", "1e300"), "pitch", "accepted is a number -10000..10000"},
      {portrait("52.594383239746094", "5000"), "pitch", "lenses across 1536 px"},
      {portrait("-7.21152925491333", "-0.0"), "slope", "is -0; accepted is a number"},
      {portrait("-7.21152925491333", "1e-320"), "slope", "of 0.01..1e+06 in size"},
      {portrait("0.40277382731437683", "-10001"), "center", "is -10001"},
      {portrait("{\"value\":40}", "{\"value\":180}"), "viewCone", "accepted is a number 1..179"},
      {portrait("1536", "0"), "screenW", "accepted is a whole number 1..16384"},
      {portrait("1536", "16385"), "screenW", "is 16385"},
      {portrait("2048", "2048.5"), "screenH", "is 2048.5; accepted is a whole number"},
      {portrait("2048", "-2048"), "screenH", "is -2048"},
      {portrait("\"invView\":{\"value\":1}", "\"invView\":\"yes\""), "invView", "is \"yes\""},
      {portrait("\"CellPatternMode\":{\"value\":0}", "\"CellPatternMode\":5"), "CellPatternMode",
       "accepted is a whole number 0..4"},
      {portrait("\"CellPatternMode\":{\"value\":0}", "\"cellPatternMode\":-1"), "cellPatternMode",
       "is -1"},
      {portrait("\"LKG-PORT-\"", "17"), "serial", "is 17; accepted is a text"},
      {portrait("\"LKG-PORT-\"", '"' + std::string(101, 'x') + '"'), "serial", "up to 100 bytes"},
  };
  for (const Broken& broken : files) expectRefused(broken);
}

TEST(Calibration, refusesWrongCells) {
  const auto third = [](const char* from, const char* to) {
    return edited(kThirdGenerationFile, from, to);
  };
  const std::string five = "[{},{},{},{},{}]";
  const std::vector<Broken> files = {
      {edited(kPortraitFile, "[]", five), "subpixelCells", "accepted is a list of up to 4 cells"},
      {edited(kPortraitFile, "[]", "{}"), "subpixelCells", "is {}"},
      {edited(kPortraitFile, "[]", "[{}]"), "subpixelCells[0].ROffsetX", "is missing"},
      {edited(kPortraitFile, "[]", "[7]"), "subpixelCells[0]", "is 7; accepted is an object"},
      {third("-0.31,\"ROffsetY\":-0.25", "-31,\"ROffsetY\":-0.25"), "subpixelCells[1].ROffsetX",
       "is -31; accepted is a number -16..16"},
      {third("\"BOffsetY\":0.25", "\"BOffsetY\":\"\""), "subpixelCells[1].BOffsetY", "is \"\""},
  };
  for (const Broken& broken : files) expectRefused(broken);
}

TEST(Calibration, refusesWhatIsNoObjectInJson) {
  const std::string long_file = std::string(kPortraitFile) + std::string(65 << 10, ' ');
  const std::vector<Broken> files = {
      {"", "calibration", "is no JSON"},
      {"{", "calibration", "is no JSON"},
      {"[]", "calibration", "is []; accepted is one JSON object"},
      {"\"\"", "calibration", "is no JSON"},
      {"\"\\\"{}\\\"\"", "calibration", "accepted is one JSON object"},
      {edited(kPortraitFile, "324", "NaN"), "calibration", "is no JSON"},
      {edited(kPortraitFile, "324", "Infinity"), "calibration", "is no JSON"},
      {edited(kPortraitFile, "324", "1e999"), "calibration", "is no JSON"},
      {edited(kPortraitFile, "PORT", "\xff"), "calibration", "is no JSON"},
      {std::string(60000, '['), "calibration", "nests lists or objects deeper than 16"},
      {std::string(kPortraitFile.substr(0, 200)), "calibration", "is no JSON"},
      {long_file, "calibration", "accepted are up to 65536"},
  };
  for (const Broken& broken : files) expectRefused(broken);
}

// Printing nested values takes stack for each level.
TEST(Calibration, refusesDeepNesting) {
  const std::string deep = std::string(30000, '[') + std::string(30000, ']');
  for (const std::string& file :
       {deep, "{\"pitch\":" + deep + "}", edited(kPortraitFile, "324", deep),
        "{\"a\":" + std::string(17, '[') + std::string(17, ']') + "}"}) {
    expectRefused({file, "calibration", "nests lists or objects deeper than 16"});
  }
  const std::string allowed = std::string(10, '[') + std::string(10, ']');
  expectRefused({edited(kPortraitFile, "324", allowed), "DPI", "is [[[[[[[[[["});
}

// CPU time to refuse a list of so many empty objects; the least of three attempts.
int64_t refusalNs(size_t object_count) {
  std::string list = "[{}";
  for (size_t i = 1; i < object_count; ++i) list += ",{}";
  list += ']';
  int64_t least_ns = std::numeric_limits<int64_t>::max();
  for (int attempt = 0; attempt < 3; ++attempt) {
    const int64_t begin_ns = threadTimeNs();
    EXPECT_FALSE(parseCalibration(list).ok());
    least_ns = std::min(least_ns, threadTimeNs() - begin_ns);
  }
  return least_ns;
}

// Ten times the text may take ten times as long, not a hundred times.
TEST(Calibration, refusesLongListsInLinearTime) {
  EXPECT_LT(refusalNs(20'000), 40 * refusalNs(2'000));
}

TEST(Calibration, quotesLongValuesInPart) {
  const std::string file = edited(kPortraitFile, "324", '"' + std::string(5000, 'y') + '"');
  const std::string said(parseCalibration(file).status().message());
  EXPECT_THAT(said, HasSubstr("yyy..."));
  EXPECT_LT(said.size(), 300u);
}

}  // namespace
}  // namespace viewloom::calibration_test
