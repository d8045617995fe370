// SPDX-License-Identifier: Apache-2.0
// Depth of scanners, and depth that lies upside down on its picture: what is said about them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "unit/cli/wrong_files.h"

namespace viewloom::test::scanned_depth_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

std::vector<std::string> kindsOf(const LayerInspection& layer) {
  std::vector<std::string> kinds;
  for (const inspect::Suspicion& suspicion : layer.suspicions) kinds.push_back(suspicion.kind);
  return kinds;
}

class ScannedDepthTest : public WrongFilesTest {
 protected:
  // The scene ten times as large, of which a scanner sees so much.
  FrameFiles scanned(double codes_per_m, double seen) const {
    std::mt19937 random(11);
    std::bernoulli_distribution is_seen(seen);
    return pair(16, [&](int x, int y) {
      return is_seen(random) ? 10 * codes_per_m * double{roomAt(x, y)} : 0.0;
    });
  }
};

TEST_F(ScannedDepthTest, isTakenForThatOfKitti) {
  for (const double seen : {0.05, 0.2}) {
    const FrameFiles files = scanned(256, seen);
    EXPECT_EQ(remedyOf(inspected(files), "scale"), "--input kitti") << seen;
    const LayerInspection mended = inspected(files, "--input kitti");
    // Pixels without a measurement stay empty. They are reported without a useless remedy.
    EXPECT_THAT(kindsOf(mended), ElementsAre("empty")) << seen;
    EXPECT_THAT(mended.suspicions[0].sentence, HasSubstr("scattered over the picture")) << seen;
    EXPECT_EQ(mended.suspicions[0].remedy, "") << seen;
    EXPECT_LT(rangeError(mended, 10 / (0.25 + 0.025 * 20), 40), 0.1) << seen;
    EXPECT_EQ(remedyOf(inspected(files, "--depth-meaning disparity"), "scale"),
              "--input kitti --depth-meaning planar")
        << seen;
  }
}

// Two cameras that find no match in places: sensors of this kind count millimetres.
TEST_F(ScannedDepthTest, isNotThatOfAMatcherWithHoles) {
  std::mt19937 random(12);
  std::bernoulli_distribution is_seen(0.95);
  const FrameFiles files =
      pair(16, [&](int x, int y) { return is_seen(random) ? 1000 * double{roomAt(x, y)} : 0.0; });
  EXPECT_EQ(remedyOf(inspected(files), "scale"), "--input sensor");
}

// Every surface has a colour of its own.
float colorAt(int x, int y) {
  const float z = roomAt(x, y);
  return z == 1.5F ? 0.9F : z == 2.5F ? 0.1F : y < 44 ? 0.4F : 0.6F;
}
float fromBelow(int x, int y) {
  return roomAt(x, kHeight - 1 - y);
}

class UpsideDownTest : public WrongFilesTest {};

TEST_F(UpsideDownTest, isSeenByTheEdgesOfColour) {
  const FrameFiles files = exr(fromBelow, colorAt);
  EXPECT_EQ(remedyOf(inspected(files), "upside-down"), "--flip");
  EXPECT_THAT(kindsOf(inspected(files, "--flip")), IsEmpty());
  const FrameFiles right = exr(roomAt, colorAt);
  EXPECT_THAT(kindsOf(inspected(right)), IsEmpty());
  const LayerInspection turned = inspected(right, "--flip");
  EXPECT_EQ(remedyOf(turned, "upside-down"), "without --flip");
}

TEST_F(UpsideDownTest, isNotGuessedWhereColourTellsNothing) {
  EXPECT_THAT(kindsOf(inspected(exr(fromBelow))), IsEmpty()) << "hardly any edges of colour";
  std::mt19937 random(13);
  std::uniform_real_distribution<float> noise(0, 1);
  const auto texture = [&](int, int) { return noise(random); };
  EXPECT_THAT(kindsOf(inspected(exr(fromBelow, texture))), IsEmpty()) << "edges everywhere";
}

TEST_F(UpsideDownTest, isSaidInTheWordsOfAManifest) {
  exr(fromBelow, colorAt);
  folder_.write("frame.json", R"({"sources": [{"layers": [{"color": {"file": "scene.exr"},
      "depth": {"file": "scene.exr", "depth": {"meaning": "DEPTH_MEANING_PLANAR"}}}]}]})");
  const LayerInspection layer =
      inspected({.manifest = file("frame.json"), .deep = {}, .input = {}});
  ASSERT_THAT(kindsOf(layer), ElementsAre("upside-down"));
  EXPECT_THAT(layer.suspicions[0].remedy, StartsWith(R"(try "flip": true in "depth" ()"));
}

}  // namespace
}  // namespace viewloom::test::scanned_depth_test
