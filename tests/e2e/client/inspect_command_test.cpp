// SPDX-License-Identifier: Apache-2.0
// `viewloom inspect` as a process: what it says of files, draws of them and refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "files/png_image.h"
#include "support/deep_exr_writer.h"
#include "unit/client/test_files.h"
#include "unit/inputs/written_files.h"
#include "unit/photos/written_photo.h"

namespace viewloom::test::inspect_command_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using ::testing::HasSubstr;

class InspectCommand : public ::testing::Test {
 protected:
  struct Finished {
    int exit_code = -1;
    std::string output;
    std::string errors;
  };

  Finished inspect(const std::string& arguments) const {
    const std::string out = folder_.path() / "out.txt", err = folder_.path() / "err.txt";
    const std::string command =
        std::string(VIEWLOOM) + " inspect " + arguments + " >" + out + " 2>" + err;
    const int status = std::system(command.c_str());
    return {.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            .output = files::bytesOf(out),
            .errors = files::bytesOf(err)};
  }
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  // 8x4 px of Blender: red at 2 m on the left, at 4 m on the right, nothing in the last row.
  void writeBlender(const std::string& name) const {
    const auto constant = [](const char* channel, float value) {
      return WrittenChannel{channel, Imf::HALF, [value](int, int) { return value; }};
    };
    writeExr(file(name), 8, 4,
             {constant("ViewLayer.Combined.R", 1),
              constant("ViewLayer.Combined.G", 0),
              constant("ViewLayer.Combined.B", 0),
              constant("ViewLayer.Combined.A", 1),
              {"ViewLayer.Depth.Z", Imf::FLOAT, [](int x, int y) {
                 return y == 3 ? 1e10F : x < 4 ? 2.0F : 4.0F;
               }}});
  }

  const files::TestFolder folder_;
};

TEST_F(InspectCommand, saysWhatAFileIsAndHowItIsRead) {
  writeBlender("render.exr");
  const Finished run = inspect(file("render.exr"));
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("scan lines 8x4 px: ViewLayer.Combined.A (half)"));
  EXPECT_THAT(run.output, HasSubstr("read as   blender"));
  EXPECT_THAT(run.output, HasSubstr("metres along the view axis = sample x 1 + 0; 1e+10 is "
                                    "infinitely far"));
  EXPECT_THAT(run.output, HasSubstr("2 .. 4 m, median"));
  EXPECT_THAT(run.output, HasSubstr("75.0 % surface, 25.0 % infinitely far"));
  EXPECT_THAT(run.output, HasSubstr("assumed: give --fov or --focal-px"));
  EXPECT_THAT(inspect(file("render.exr") + " --fov 50").output, testing::Not(HasSubstr("assumed")));
}

TEST_F(InspectCommand, saysItToMachines) {
  writeBlender("render.exr");
  const Finished run = inspect("--json " + file("render.exr") + " " + file("gone.exr"));
  ASSERT_EQ(run.exit_code, 2) << "one of the two is not there";
  const Finished good = inspect("--json " + file("render.exr"));
  ASSERT_EQ(good.exit_code, 0) << good.errors;
  const Json report = Json::parse(good.output);
  ASSERT_EQ(report.size(), 1U);
  EXPECT_EQ(report[0].at("input"), "blender");
  const Json& layer = report[0].at("sources")[0].at("layers")[0];
  EXPECT_EQ(layer.at("depth").at("min_m"), 2);
  EXPECT_EQ(layer.at("depth").at("max_m"), 4);
  EXPECT_EQ(layer.at("depth").at("sky_count"), 8);
  EXPECT_EQ(layer.at("color").at("primaries"), "bt709");
  EXPECT_EQ(layer.at("color").at("transfer"), "linear");
}

// 8 x 4 px of 4 px of focal length: slopes up to 1 to the sides, 0.5 up and down. Square views
// frame half of the width at 2 m, and see the sky furthest to the side.
TEST_F(InspectCommand, saysWhichViewsOfADisplayLookPastTheFile) {
  writeBlender("render.exr");
  const std::string file_and_display =
      file("render.exr") + " --focal-px 4 --columns 4 --rows 1 --size 40x10 --focal-distance 2";
  EXPECT_THAT(inspect(file_and_display + " --cone 20").output,
              HasSubstr("display   no view sees past the edge of the source"));
  // Eyes at 2 tan(0.75 * 50 degrees) = 1.535 m: the sky at a slope of (1 + 1.535) / 2 = 1.267, past
  // the image's edge at 1 of 2. The inner two stand at 0.443 m.
  const Finished run = inspect(file_and_display + " --cone 100 --json");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const Json outside = Json::parse(run.output)[0].at("display").at("views_outside");
  ASSERT_EQ(outside.size(), 2U);
  EXPECT_EQ(outside[0].at("first_view"), 0);
  EXPECT_EQ(outside[0].at("last_view"), 0);
  EXPECT_NEAR(outside[0].at("share"), (0.5 + std::tan(37.5 * M_PI / 180) - 1) / 2, 1e-9);
  EXPECT_EQ(outside[1].at("first_view"), 3);
  EXPECT_THAT(inspect(file_and_display + " --cone 100").output,
              HasSubstr("warning   past the edge of the source see view 0 by 14 %, view 3 by 14 %. "
                        "They need a field of view of 104 x 54 degrees"));
  const Finished refused = inspect(file("render.exr") + " --preset none");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors, HasSubstr("--preset: there is no preset \"none\""));
}

TEST_F(InspectCommand, warnsAndSaysWhatToDo) {
  writePng(file("color.png"), 8, 4, 3, 8, std::vector<uint16_t>(96, 90));
  std::vector<uint16_t> depth_mm;
  for (uint16_t i = 0; i < 32; ++i) depth_mm.push_back(static_cast<uint16_t>(1500 + 37 * i));
  writePng(file("depth.png"), 8, 4, 1, 16, depth_mm);
  const std::string pair = file("color.png") + " --depth " + file("depth.png");
  EXPECT_THAT(inspect(pair).output, HasSubstr("warning   scale: half of the surfaces are beyond"));
  const Finished right = inspect(pair + " --input sensor");
  EXPECT_EQ(right.exit_code, 0) << right.errors;
  EXPECT_THAT(right.output, testing::Not(HasSubstr("warning   scale")));
  EXPECT_THAT(right.output, HasSubstr("1.5 .. 2.647 m"));
}

// Least and largest distance, as the options on the command line have it.
TEST_F(InspectCommand, takesEveryKindOfInputByName) {
  writePng(file("color.png"), 4, 1, 3, 8, std::vector<uint16_t>(12, 90));
  writePng(file("depth.png"), 4, 1, 1, 16, {13107, 26214, 39321, 65535});
  writePng(file("v0_depth.png"), 4, 1, 1, 16, {13107, 26214, 39321, 65535});
  writePng(file("halves.png"), 8, 1, 1, 8, {51, 102, 153, 255, 9, 9, 9, 9});
  folder_.write("camera.json", R"({"Name": "v0", "Position": [0, 0, 0], "Rotation": [0, 0, 0],
      "Resolution": [4, 1], "Focal": [4, 4], "Principle_point": [2, 0.5],
      "Depth_range": [1, "inf"]})");
  const std::string pair = file("color.png") + " --depth " + file("depth.png");
  const auto range = [&](const std::string& arguments) {
    const Finished run = inspect("--json " + arguments);
    if (run.exit_code != 0) return run.errors;
    const Json depth = Json::parse(run.output)[0]["sources"][0]["layers"][0]["depth"];
    return std::to_string(std::lround(1000 * depth.value("min_m", 0.0))) + ".." +
           std::to_string(std::lround(1000 * depth.value("max_m", 0.0)));
  };
  const std::string to_infinity = " --depth-near 1 --depth-far inf";
  EXPECT_EQ(range(pair + " --input sensor"), "13107..65535");
  EXPECT_EQ(range(pair + " --input relative" + to_infinity), "1000..5000");
  EXPECT_EQ(range(pair + " --input relative --black-near --depth-near 1 --depth-far 5"),
            "1190..5000");
  EXPECT_EQ(range(pair + " --input iphone --depth-near 0.5 --depth-far inf"), "500..2500");
  EXPECT_EQ(range(pair + " --input openxr --depth-near inf --depth-far 1"), "1000..5000");
  EXPECT_EQ(range(pair + " --input openxr --depth-near 1 --depth-far inf"), "1250..2500");
  EXPECT_EQ(range(file("color.png") + " --depth " + file("v0_depth.png") + " --camera " +
                  file("camera.json")),
            "1000..5000");
  EXPECT_EQ(range(file("halves.png") + " --input rgbd --depth-side left" + to_infinity),
            "1000..5000");
  EXPECT_EQ(
      range(file("halves.png") + " --input 2d+z --depth-side left --screen 2 --screen-code 255"),
      "2000..10000");
  EXPECT_EQ(range(pair + " --depth-meaning disparity --depth-scale 1e-5"), "1526..7630");
  EXPECT_EQ(inspect(pair + " --input tmiv").exit_code, 2) << "without a camera";
  EXPECT_EQ(inspect(pair + " --input sonar").exit_code, 2);
}

TEST_F(InspectCommand, knowsPortraitPhotos) {
  WrittenPhoto photo = portrait();
  writePhoto(file("IMG_1.HEIC"), photo);
  const Finished run = inspect(file("IMG_1.HEIC"));
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.output,
              HasSubstr("HEIC, 192x144 px; depth 96x72 px: urn:mpeg:hevc:2015:auxid:2"));
  EXPECT_THAT(run.output, HasSubstr("read as   iphone"));
  EXPECT_THAT(run.output, HasSubstr("0.25 .. 1.525 1/m by its XMP"));
  EXPECT_THAT(run.output, HasSubstr("focal length 26 mm of Exif"));
  // Twice atan(18 / 26); codes up to 255 of 0.005 each.
  EXPECT_THAT(run.output, HasSubstr("69.4 x 54.9 degrees"));
  EXPECT_THAT(run.output, HasSubstr("RGB of 8 bits, srgb, display_p3, alpha opaque"));
  EXPECT_THAT(run.output, HasSubstr("1/Z in 1/m = sample x 0.005 + 0.25"));
  EXPECT_THAT(run.output, testing::Not(HasSubstr("assumed")));
  photo.has_second = false;
  writePhoto(file("IMG_2.HEIC"), photo);
  const Finished refused = inspect(file("IMG_2.HEIC"));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors, HasSubstr("IMG_2.HEIC: has no depth"));
  EXPECT_THAT(refused.errors, HasSubstr("take it in portrait mode, or give --depth FILE"));
}

TEST_F(InspectCommand, drawsColourBesideDepth) {
  writeBlender("render.exr");
  const Finished run = inspect(file("render.exr") + " --picture " + file("look.png"));
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const auto look = files::readPngColor(file("look.png"), false);
  ASSERT_TRUE(look.ok()) << look.status();
  ASSERT_EQ(look->width_px, 16U);
  ASSERT_EQ(look->height_px, 4U);
  const auto pixel = [&](size_t x, size_t y) {
    const uint8_t* const rgb = &look->bytes[3 * (16 * y + x)];
    return std::vector<int>{rgb[0], rgb[1], rgb[2]};
  };
  EXPECT_EQ(pixel(2, 1), (std::vector<int>{255, 0, 0}));
  EXPECT_EQ(pixel(8, 0), (std::vector<int>{255, 255, 255})) << "near";
  EXPECT_EQ(pixel(15, 0), (std::vector<int>{0, 0, 0})) << "far";
  EXPECT_EQ(pixel(8, 3), (std::vector<int>{0, 0, 0})) << "sky";
  // The same file where the background is no surface.
  ASSERT_EQ(
      inspect(file("render.exr") + " --depth-invalid 4 --picture " + file("look.png")).exit_code,
      0);
  const auto holes = files::readPngColor(file("look.png"), false);
  const uint8_t* const hole = &holes->bytes[3 * 15];
  EXPECT_EQ((std::vector<int>{hole[0], hole[1], hole[2]}), (std::vector<int>{0, 0, 0}))
      << "4 is infinitely far, as the kind has it";
}

TEST_F(InspectCommand, marksWhatIsNoSurface) {
  writePng(file("color.png"), 4, 1, 3, 8, std::vector<uint16_t>(12, 90));
  writePng(file("depth.png"), 4, 1, 1, 16, {0, 1000, 2000, 3000});
  ASSERT_EQ(inspect(file("color.png") + " --depth " + file("depth.png") +
                    " --input sensor --picture " + file("look.png"))
                .exit_code,
            0);
  const auto look = files::readPngColor(file("look.png"), false);
  ASSERT_TRUE(look.ok()) << look.status();
  const uint8_t* const rgb = &look->bytes[3 * 4];
  EXPECT_EQ((std::vector<int>{rgb[0], rgb[1], rgb[2]}), (std::vector<int>{255, 0, 255}));
}

TEST_F(InspectCommand, goesOnAfterAFileThatCannotBeReadAndSaysSo) {
  writeBlender("render.exr");
  folder_.write("broken.exr", files::bytesOf(file("render.exr")).substr(0, 300));
  const Finished run =
      inspect(file("broken.exr") + " " + file("render.exr") + " --picture " + file("look.png"));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.errors, HasSubstr("broken.exr: "));
  EXPECT_THAT(run.output, HasSubstr("read as   blender"));
  EXPECT_TRUE(fs::exists(file("look.png"))) << "of the first frame that can be read";
  EXPECT_EQ(inspect("").exit_code, 2);
  EXPECT_EQ(inspect(file("none.exr")).exit_code, 2);
  EXPECT_FALSE(fs::exists(file("none.png")));
}

TEST_F(InspectCommand, knowsDeepFilesAndManifests) {
  writePng(file("color.png"), 4, 4, 3, 8, std::vector<uint16_t>(48, 90));
  writePng(file("depth.png"), 4, 4, 1, 16, std::vector<uint16_t>(16, 700));
  folder_.write("frame.json", R"({"sources": [{"camera": {"intrinsics": {"focalXPx": 4,
      "focalYPx": 4, "principalXPx": 2, "principalYPx": 2}}, "layers": [{"color":
      {"file": "color.png"}, "depth": {"file": "depth.png", "depth": {"meaning":
      "DEPTH_MEANING_PLANAR", "scale": 0.01}}}]}]})");
  const Finished run = inspect(file("frame.json"));
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("read as   manifest"));
  EXPECT_THAT(run.output, HasSubstr("7 .. 7 m"));
  EXPECT_THAT(run.output, HasSubstr("warning   flat"));
  const Imath::Box2i window(Imath::V2i(0, 0), Imath::V2i(1, 0));
  const deep::DeepSample near{.z_m = 2, .z_back_m = 2, .alpha = 1, .color = {0.5, 0.5, 0.5}};
  writeDeepExr(file("deep.exr"), {.data = window, .display = window, .pixels = {{near}, {near}}},
               {});
  const Finished deep = inspect(file("deep.exr"));
  EXPECT_EQ(deep.exit_code, 0) << deep.errors;
  EXPECT_THAT(deep.output, HasSubstr("read as   deep"));
  EXPECT_THAT(deep.output, HasSubstr("split into 1 layer"));
  EXPECT_THAT(deep.output, HasSubstr("2 .. 2 m"));
}

// Depth given upside down is suspected on a real picture, and the right one is not.
TEST_F(InspectCommand, judgesRealPictures) {
  const fs::path data = VIEWLOOM_SHARED_DATA;
  if (!fs::exists(data)) GTEST_SKIP() << data << " is not there";
  const std::string antinous = (data / "hci-antinous/input_Cam040.png").string() + " --depth " +
                               (data / "hci-antinous/gt_disp_lowres.pfm").string() +
                               " --depth-meaning disparity --depth-offset 0.125 --depth-scale ";
  const Finished right = inspect(antinous + "0.025");
  EXPECT_EQ(right.exit_code, 0) << right.errors;
  EXPECT_THAT(right.output, testing::Not(HasSubstr("warning")));
  EXPECT_THAT(inspect(antinous + "-0.025").output, HasSubstr("warning   inside-out"));
  const std::string ball = (data / "beachball-stereo/singlepart.0001.exr").string();
  EXPECT_THAT(inspect(ball).output, HasSubstr("try --depth-far-zero"));
  EXPECT_THAT(inspect(ball + " --depth-far-zero").output, testing::Not(HasSubstr("warning")));
}

}  // namespace
}  // namespace viewloom::test::inspect_command_test
