// SPDX-License-Identifier: Apache-2.0
// `viewloomd render` on pictures and depth that others made, against the true other views. The data
// lies beside the source tree; without it the tests are skipped.
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include <Imath/half.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "e2e/run_viewloomd.h"
#include "files/exr_image.h"
#include "files/file_bytes.h"
#include "files/pfm_image.h"
#include "files/png_writer.h"
#include "support/forward_map.h"

namespace viewloom::test {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

// One source, one view of the same size, parallel to it; lengths in units of the data.
struct Pair {
  SizePx size_px;
  Intrinsics source;
  Camera view;
  Json color_file;
  Json depth_file;
  Json truth_file;
};

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

class RealDataTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(data_)) GTEST_SKIP() << "there is no data in " << data_;
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const Json& json) {
    std::ofstream(folder_ / name) << json.dump();
  }

  // The report of a successful `viewloomd render` of the pair.
  Json render(const Pair& pair, const std::vector<uint8_t>& covered, const std::string& flags) {
    const Json source = {{"camera", cameraJson({.intrinsics = pair.source})},
                         {"layers", {{{"color", pair.color_file}, {"depth", pair.depth_file}}}}};
    write("frame.json", {{"sources", {source}}});
    write("display.json",
          {{"cameras",
            {{"cameras", {cameraJson(pair.view)}},
             {"tileSize", {{"width", pair.size_px.width}, {"height", pair.size_px.height}}}}}});
    write("truth.json", {{"views", {{{"viewIndex", 0}, {"color", pair.truth_file}}}}});
    const auto png = files::encodePng(covered, pair.size_px.width, pair.size_px.height, 1);
    EXPECT_TRUE(png.ok()) << png.status();
    EXPECT_TRUE(files::writeFileWhole(folder_ / "covered.png", *png).ok());

    const std::string prefix = folder_.string() + "/";
    const FinishedRun run =
        runViewloomd("render --frame " + prefix + "frame.json --display " + prefix +
                     "display.json --out " + prefix + "out --compare " + prefix +
                     "truth.json --covered-mask " + prefix + "covered.png " + flags);
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    return Json::parse(run.output).at("views").at(0);
  }

  const fs::path data_ = fs::path(VIEWLOOM_SOURCE_DIR) / ".." / "shared" / "data";
  const fs::path folder_ =
      fs::temp_directory_path() / ("viewloom_real_" + std::to_string(getpid()));
};

std::vector<float> floatsOf(const files::PlaneImage& image) {
  std::vector<float> values(size_t{image.width_px} * image.height_px);
  if (image.encoding == v1::PLANE_ENCODING_DEPTH_F32) {
    std::memcpy(values.data(), image.bytes.data(), values.size() * sizeof(float));
    return values;
  }
  for (size_t i = 0; i < values.size(); ++i) {
    uint16_t half = 0;
    std::memcpy(&half, &image.bytes[2 * i], sizeof half);
    values[i] = Imath::half(Imath::half::FromBits, half);
  }
  return values;
}

// The right eye and the left one.
Pair beachBall(const fs::path& file, const std::vector<std::string>& color_channels) {
  // Parallel cameras with focal length x baseline = 333.32 px m; Z = 0 is the black background.
  constexpr double kFocal_px = 2048;
  constexpr double kFocalBaseline_px_m = 333.32;
  const Intrinsics intrinsics = {{kFocal_px, kFocal_px}, {1024, 778}};
  return {.size_px = {2048, 1556},
          .source = intrinsics,
          .view = {{.position_m = {-kFocalBaseline_px_m / kFocal_px, 0, 0}}, intrinsics},
          .color_file = {{"file", file.string()}, {"channels", color_channels}},
          .depth_file = {{"file", file.string()},
                         {"channels", {"Z"}},
                         {"depth",
                          {{"meaning", "DEPTH_MEANING_PLANAR"},
                           {"invalidValue", 0},
                           {"invalidIsFar", true}}}},
          .truth_file = {{"file", file.string()}, {"channels", {"left.R", "left.G", "left.B"}}}};
}

TEST_F(RealDataTest, rendersTheBeachBallsLeftEyeFromItsRight) {
  const fs::path file = data_ / "beachball-stereo" / "singlepart.0001.exr";
  if (!fs::exists(file)) GTEST_SKIP() << "there is no " << file;
  const Pair pair = beachBall(file, {"R", "G", "B"});
  const auto depth = files::readExrDepth(file, std::vector<std::string>{"Z"});
  ASSERT_TRUE(depth.ok()) << depth.status();
  InvZImage source = {.size_px = pair.size_px, .inv_z = floatsOf(*depth)};
  for (float& z : source.inv_z) z = z == 0 ? 0 : 1 / z;
  const InvZImage mapped = forwardMap(source, pair.source, pair.view, pair.size_px);

  const Json score = render(pair, coveredMask(mapped), "--transfer gamma2.2");
  EXPECT_GE(score["by_renderer"]["all"]["psnr_db"].get<double>(), 53.5) << score.dump(1);
  EXPECT_EQ(score["by_renderer"]["all"], score["by_mask"]["all"]);
  EXPECT_NEAR(score["by_mask"]["covered"]["share"].get<double>(),
              score["by_renderer"]["covered"]["share"].get<double>(), 0.01);
}

// The ball's limb is soft: what shows through it is the background, not the ball once more.
TEST_F(RealDataTest, rendersTheBeachBallWithItsAlpha) {
  const fs::path file = data_ / "beachball-stereo" / "singlepart.0001.exr";
  if (!fs::exists(file)) GTEST_SKIP() << "there is no " << file;
  const Pair pair = beachBall(file, {"R", "G", "B", "A"});
  const std::vector<uint8_t> all_covered(pair.size_px.area(), 255);
  const Json score = render(pair, all_covered, "--transfer gamma2.2");
  EXPECT_GE(score["by_renderer"]["all"]["psnr_db"].get<double>(), 51.5) << score.dump(1);
}

TEST_F(RealDataTest, rendersAntinousFourViewsToTheRight) {
  const fs::path folder = data_ / "hci-antinous";
  if (!fs::exists(folder)) GTEST_SKIP() << "there is no " << folder;
  // Disparity between neighbouring views d = focal * b * (1/Z - 1/Zf); b and Zf cancel in every
  // image.
  constexpr double kFocal_px = 1462.857;
  constexpr double kBaseline_m = 40 / kFocal_px;
  constexpr double kFocusDistance_m = 8;
  constexpr double kViews = 4;
  const SizePx size_px = {512, 512};
  const Intrinsics center = {{kFocal_px, kFocal_px}, {256, 256}};
  const double shift_px = kFocal_px * kBaseline_m * kViews / kFocusDistance_m;
  const double scale = 1 / (kFocal_px * kBaseline_m);
  const Pair pair = {.size_px = size_px,
                     .source = center,
                     .view = {{.position_m = {kViews * kBaseline_m, 0, 0}},
                              {center.focal_px, {256 + shift_px, 256}}},
                     .color_file = {{"file", (folder / "input_Cam040.png").string()}},
                     .depth_file = {{"file", (folder / "gt_disp_lowres.pfm").string()},
                                    {"depth",
                                     {{"meaning", "DEPTH_MEANING_DISPARITY"},
                                      {"scale", scale},
                                      {"offset", 1 / kFocusDistance_m}}}},
                     .truth_file = {{"file", (folder / "input_Cam044.png").string()}}};
  const auto disparity = files::readPfmDepth(folder / "gt_disp_lowres.pfm");
  ASSERT_TRUE(disparity.ok()) << disparity.status();
  InvZImage source = {.size_px = size_px, .inv_z = floatsOf(*disparity)};
  for (float& d : source.inv_z) d = static_cast<float>(d * scale + 1 / kFocusDistance_m);
  const InvZImage mapped = forwardMap(source, pair.source, pair.view, size_px);

  const Json score = render(pair, coveredMask(mapped), "--border 8");
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
}  // namespace viewloom::test
