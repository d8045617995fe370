// SPDX-License-Identifier: Apache-2.0
#include "cli/file_pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/client/test_files.h"
#include "unit/inputs/written_files.h"
#include "unit/photos/written_photo.h"

namespace viewloom::cli::file_pairs_test {
namespace {

using test::WrittenChannel;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

WrittenChannel ones(const std::string& name) {
  return {name, Imf::HALF, [](int, int) { return 1.0F; }};
}

class FilePairsTest : public ::testing::Test {
 protected:
  FilePairs pairs(const inputs::InputSettings& settings = {}) {
    return FilePairs(folder_.path(), settings, "");
  }
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
  // "colour + depth" of the frame, "-" when there is none yet.
  std::string add(FilePairs& pairs, const std::string& name) {
    const auto frame = pairs.add(name);
    if (!frame.ok()) return std::string(frame.status().message());
    if (!*frame) return "-";
    const auto nameOf = [](const std::string& path) {
      return std::filesystem::path(path).filename().string();
    };
    if (!(*frame)->deep.empty()) return "deep " + nameOf((*frame)->deep);
    return nameOf((*frame)->input.color) + " + " + nameOf((*frame)->input.depth);
  }

  const files::TestFolder folder_;
};

TEST(PairKey, isWhatBothNamesHaveInCommon) {
  for (const auto& [color, depth] : std::vector<std::pair<std::string, std::string>>{
           {"frame_0001.png", "frame_0001_depth.png"},
           {"Image0001.exr", "Depth0001.exr"},
           {"rgb-7.jpg", "depth-7.png"},
           {"v0_texture.png", "v0_texture_disparity.pfm"},
           {"shot colour.12.png", "shot disp.12.png"}}) {
    EXPECT_EQ(pairKey(color).key, pairKey(depth).key) << color;
    EXPECT_FALSE(pairKey(color).is_depth) << color;
    EXPECT_TRUE(pairKey(depth).is_depth) << depth;
  }
  EXPECT_NE(pairKey("frame_0001.png").key, pairKey("frame_0002_depth.png").key);
}

TEST_F(FilePairsTest, joinHalvesInEitherOrder) {
  FilePairs halves = pairs();
  EXPECT_EQ(add(halves, "a_1.png"), "-");
  EXPECT_EQ(add(halves, "a_2_depth.png"), "-");
  EXPECT_EQ(add(halves, "a_2.png"), "a_2.png + a_2_depth.png");
  EXPECT_EQ(add(halves, "a_1_depth.pfm"), "a_1.png + a_1_depth.pfm");
  // Both come anew.
  EXPECT_EQ(add(halves, "a_1.png"), "-");
  EXPECT_EQ(add(halves, "a_1_depth.pfm"), "a_1.png + a_1_depth.pfm");
}

TEST_F(FilePairsTest, leaveAloneWhatIsNoPicture) {
  FilePairs halves = pairs();
  for (const char* name : {"notes.txt", ".hidden.png", "a.png.part", "a"}) {
    EXPECT_EQ(add(halves, name), "-");
  }
  EXPECT_EQ(add(halves, "a_depth.png"), "-") << "nothing above was a half of it";
}

TEST_F(FilePairsTest, takeFilesWithColourAndDepthAlone) {
  test::writeExr(file("whole.exr"), 4, 4, {ones("R"), ones("G"), ones("B"), ones("Z")});
  test::writeExr(
      file("blend.exr"), 4, 4,
      {ones("L.Combined.R"), ones("L.Combined.G"), ones("L.Combined.B"), ones("L.Depth.Z")});
  test::writeExr(file("Image1.exr"), 4, 4, {ones("R"), ones("G"), ones("B")});
  test::writeExr(file("Depth1.exr"), 4, 4, {ones("Z")});
  FilePairs exr = pairs();
  EXPECT_EQ(add(exr, "whole.exr"), "whole.exr + ");
  EXPECT_EQ(add(exr, "blend.exr"), "blend.exr + ");
  EXPECT_EQ(add(exr, "Image1.exr"), "-");
  EXPECT_EQ(add(exr, "Depth1.exr"), "Image1.exr + Depth1.exr");
  FilePairs rgbd = pairs({.kind = inputs::InputKind::kRgbd});
  EXPECT_EQ(add(rgbd, "a.png"), "a.png + ");
}

TEST_F(FilePairsTest, leavePhotosWithDepthAlone) {
  test::WrittenPhoto photo = test::portrait();
  test::writePhoto(file("IMG_1.HEIC"), photo);
  photo.has_second = false;
  test::writePhoto(file("IMG_2.HEIC"), photo);
  FilePairs photos = pairs();
  EXPECT_EQ(add(photos, "IMG_1.HEIC"), "IMG_1.HEIC + ");
  EXPECT_EQ(add(photos, "IMG_2.HEIC"), "-");
  EXPECT_EQ(add(photos, "IMG_2_depth.png"), "IMG_2.HEIC + IMG_2_depth.png");
  FilePairs sensor = pairs({.kind = inputs::InputKind::kSensor});
  EXPECT_EQ(add(sensor, "IMG_1.HEIC"), "-") << "its depth comes from elsewhere";
  folder_.write("cut.heic", "ftyp");
  EXPECT_THAT(add(photos, "cut.heic"), HasSubstr("cut.heic: is no HEIC that can be read"));
}

TEST_F(FilePairsTest, sayWhichFileIsBroken) {
  folder_.write("cut.exr", "v/1");
  FilePairs exr = pairs();
  EXPECT_THAT(add(exr, "cut.exr"), HasSubstr("cut.exr: is no EXR file to be read"));
}

TEST_F(FilePairsTest, saysWhichHalfWaitsAndWhatItsOtherHalfIsNamed) {
  FilePairs halves = pairs();
  const auto start = std::chrono::steady_clock::now();
  ASSERT_TRUE(halves.add("a_1.png", start).ok());
  ASSERT_TRUE(halves.add("b_2.png", start).ok());
  ASSERT_TRUE(halves.add("b_2_depth.png", start).ok());
  EXPECT_THAT(halves.takeNotes(start + std::chrono::seconds(4)), IsEmpty());
  EXPECT_THAT(halves.takeNotes(start + FilePairs::kPatience),
              ElementsAre("a_1.png: waiting for its depth, named like a_1_depth.png"));
  EXPECT_THAT(halves.takeNotes(start + std::chrono::hours(1)), IsEmpty()) << "said once";
}

TEST_F(FilePairsTest, namesTheFileThatIsNearlyTheOtherHalf) {
  FilePairs halves = pairs();
  const auto start = std::chrono::steady_clock::now();
  ASSERT_TRUE(halves.add("frame_0001.png", start).ok());
  ASSERT_TRUE(halves.add("fram_0001_depth.png", start).ok());
  EXPECT_THAT(halves.takeNotes(start + FilePairs::kPatience),
              ElementsAre(HasSubstr("fram_0001_depth.png is waiting too, but its name differs"),
                          HasSubstr("frame_0001.png is waiting too, but its name differs")));
}

TEST_F(FilePairsTest, saysWhichOfTwoFilesOfOneHalfIsUsed) {
  FilePairs halves = pairs();
  EXPECT_EQ(add(halves, "a.png"), "-");
  EXPECT_EQ(add(halves, "a_color.png"), "-");
  EXPECT_THAT(halves.takeNotes({}),
              ElementsAre(HasSubstr("a.png and a_color.png are both the colour of one frame; the "
                                    "newest, a_color.png, is used")));
  EXPECT_EQ(add(halves, "a_depth.png"), "a_color.png + a_depth.png");
}

TEST_F(FilePairsTest, giveUpTheOldestOfTooManyHalves) {
  FilePairs halves = pairs();
  for (size_t i = 0; i <= FilePairs::kWaitingMax; ++i) {
    EXPECT_THAT(halves.takeGivenUp(), IsEmpty());
    EXPECT_EQ(add(halves, "a_" + std::to_string(i) + ".png"), "-");
  }
  EXPECT_THAT(halves.takeGivenUp(), ElementsAre("a_0.png"));
  EXPECT_EQ(add(halves, "a_0_depth.png"), "-");
  EXPECT_EQ(add(halves, "a_9_depth.png"), "a_9.png + a_9_depth.png");
}

}  // namespace
}  // namespace viewloom::cli::file_pairs_test
