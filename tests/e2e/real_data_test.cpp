// SPDX-License-Identifier: Apache-2.0
// `viewloom render` on pictures and depth that others made, against the true other views. The data
// lies beside the source tree; without it the tests are skipped.
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "e2e/run_program.h"
#include "files/file_bytes.h"
#include "files/png_image.h"
#include "support/data_sets.h"
#include "support/forward_map.h"

namespace viewloom::test::real_data_test {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

Json cameraJson(const Camera& camera) {
  const glm::dvec3& position = camera.pose.position_m;
  const Intrinsics& k = camera.intrinsics;
  return {{"pose", {{"position", {{"x", position.x}, {"y", position.y}, {"z", position.z}}}}},
          {"intrinsics",
           {{"focalXPx", k.focal_px.x},
            {"focalYPx", k.focal_px.y},
            {"principalXPx", k.principal_px.x},
            {"principalYPx", k.principal_px.y}}}};
}

Json jsonOf(const google::protobuf::Message& message) {
  std::string text;
  EXPECT_TRUE(google::protobuf::util::MessageToJsonString(message, &text).ok());
  return Json::parse(text);
}

class RealDataTest : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* set : {"beachball-stereo", "hci-antinous"}) {
      if (!fs::exists(data_ / set)) GTEST_SKIP() << "there is no " << data_ / set;
    }
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const Json& json) {
    std::ofstream(folder_ / name) << json.dump();
  }

  // The report of a successful `viewloom render` of one view of the set.
  Json render(const DataSet& set, const TrueView& view, const std::vector<uint8_t>& covered,
              const std::string& flags) {
    v1::TruthManifest truth;
    *truth.add_views()->mutable_color() = view.color;
    write("frame.json", jsonOf(frameManifest(set)));
    write("display.json",
          {{"cameras",
            {{"cameras", {cameraJson(cameraOf(set, view))}},
             {"tileSize", {{"width", set.size_px.width}, {"height", set.size_px.height}}}}}});
    write("truth.json", jsonOf(truth));
    const auto png = files::encodePng(covered, set.size_px.width, set.size_px.height, 1);
    EXPECT_TRUE(png.ok()) << png.status();
    EXPECT_TRUE(files::writeFileWhole(folder_ / "covered.png", *png).ok());

    const std::string prefix = folder_.string() + "/";
    const FinishedRun run =
        runViewloom("render --frame " + prefix + "frame.json --display " + prefix +
                    "display.json --out " + prefix + "out --compare " + prefix +
                    "truth.json --covered-mask " + prefix + "covered.png " + flags);
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    return Json::parse(run.output).at("views").at(0);
  }

  const fs::path data_ = fs::path(VIEWLOOM_SOURCE_DIR) / ".." / "shared" / "data";
  const fs::path folder_ =
      fs::temp_directory_path() / ("viewloom_real_" + std::to_string(getpid()));
};

std::vector<uint8_t> coveredMaskOf(const DataSet& set, const TrueView& view) {
  InvZImage source = {.size_px = set.size_px, .inv_z = set.disparity_px};
  for (float& inv_z : source.inv_z) {
    inv_z = float(inv_z / (set.focal_px * set.baseline_m) + set.inv_z_in_focus);
  }
  return coveredMask(
      forwardMap(source, sourceCamera(set).intrinsics, cameraOf(set, view), set.size_px));
}

const TrueView& viewNamed(const DataSet& set, const std::string& name) {
  return *std::find_if(set.views.begin(), set.views.end(),
                       [&](const TrueView& view) { return view.name == name; });
}

TEST_F(RealDataTest, rendersTheBeachBallsLeftEyeFromItsRight) {
  const auto set = loadBeachBall(data_, {"R", "G", "B"});
  ASSERT_TRUE(set.ok()) << set.status();
  const TrueView& view = set->views.front();
  const Json score = render(*set, view, coveredMaskOf(*set, view), "--transfer gamma2.2");
  EXPECT_GE(score["by_renderer"]["all"]["psnr_db"].get<double>(), 53.5) << score.dump(1);
  EXPECT_EQ(score["by_renderer"]["all"], score["by_mask"]["all"]);
  EXPECT_NEAR(score["by_mask"]["covered"]["share"].get<double>(),
              score["by_renderer"]["covered"]["share"].get<double>(), 0.01);
}

// The ball's limb is soft: what shows through it is the background, not the ball once more.
TEST_F(RealDataTest, rendersTheBeachBallWithItsAlpha) {
  const auto set = loadBeachBall(data_, {"R", "G", "B", "A"});
  ASSERT_TRUE(set.ok()) << set.status();
  const std::vector<uint8_t> all_covered(set->size_px.area(), 255);
  const Json score = render(*set, set->views.front(), all_covered, "--transfer gamma2.2");
  EXPECT_GE(score["by_renderer"]["all"]["psnr_db"].get<double>(), 51.5) << score.dump(1);
}

TEST_F(RealDataTest, rendersAntinousFourViewsToTheRight) {
  const auto set = loadAntinous(data_);
  ASSERT_TRUE(set.ok()) << set.status();
  const TrueView& view = viewNamed(*set, "044");
  const Json score = render(*set, view, coveredMaskOf(*set, view), "--border 8");
  EXPECT_GE(score["by_mask"]["covered"]["psnr_db"].get<double>(), 44) << score.dump(1);
  EXPECT_GE(score["by_mask"]["covered"]["share"].get<double>(), 0.9);
}

TEST(ForwardMap, movesAPlaneByItsDisparityAndKeepsTheNearest) {
  // A wall at 1/Z = 0.1 with a nearer column at x = 7; the view 1 m to the right, focal length 20
  // px: the wall moves 2 px to the left, the column 6 px at 1/Z = 0.3.
  InvZImage source = {.size_px = {10, 1}, .inv_z = std::vector<float>(10, 0.1F)};
  source.inv_z[7] = 0.3F;
  const Intrinsics intrinsics = {{20, 20}, {5, 0.5}};
  const InvZImage mapped =
      forwardMap(source, intrinsics, {{.position_m = {1, 0, 0}}, intrinsics}, {10, 1});
  const std::vector<float> expected = {0.1F, 0.3F, 0.1F, 0.1F, 0.1F, -1, 0.1F, 0.1F, -1, -1};
  EXPECT_EQ(mapped.inv_z, expected);
  EXPECT_EQ(coveredMask(mapped),
            (std::vector<uint8_t>{255, 255, 255, 255, 255, 0, 255, 255, 0, 0}));
}

}  // namespace
}  // namespace viewloom::test::real_data_test
