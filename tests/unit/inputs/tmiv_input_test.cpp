// SPDX-License-Identifier: Apache-2.0
// Camera parameters and raw video as MPEG's test model has them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "inputs/tmiv_camera.h"
#include "unit/client/test_files.h"
#include "unit/inputs/written_files.h"

namespace viewloom::test::tmiv_input_test {
namespace {

using files::TestFolder;
using inputs::InputKind;
using ::testing::HasSubstr;

constexpr uint32_t kWidth = 4, kHeight = 2;

std::string cameraJson(const std::string& name, const std::string& more) {
  return R"({"Name": ")" + name +
         R"(", "Position": [1.0, 2.0, 3.0], "Rotation": [90.0, 0.0, 0.0], "Depthmap": 1,
             "Resolution": [4, 2], "Projection": "Perspective", "Focal": [8.0, 7.0],
             "Principle_point": [2.5, 1.0], "BitDepthColor": 10, "BitDepthDepth": 16,
             "ColorSpace": "YUV420", "DepthColorSpace": "YUV420", "Depth_range": [0.5, 25.0])" +
         more + "}";
}

class TmivInputTest : public ::testing::Test {
 protected:
  TmivInputTest() {
    write(R"({"Version": "4.0", "cameras": [)" + cameraJson("v0", R"(, "HasInvalidDepth": true)") +
          "," + cameraJson("v1", "") + "]}");
    settings_.camera_file = folder_.path() / "cameras.json";
  }
  void write(const std::string& json) { folder_.write("cameras.json", json); }
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  // Luma of `frames`, chroma of no colour.
  void writeYuv(const std::string& name, const std::vector<std::vector<uint16_t>>& frames,
                uint16_t chroma) const {
    std::ofstream out(file(name), std::ios::binary);
    const auto put = [&out](uint16_t sample) {
      out.put(static_cast<char>(sample & 0xFF));
      out.put(static_cast<char>(sample >> 8));
    };
    for (const std::vector<uint16_t>& luma : frames) {
      for (const uint16_t sample : luma) put(sample);
      for (int i = 0; i < 2 * 2; ++i) put(chroma);
    }
  }

  const TestFolder folder_;
  inputs::InputSettings settings_;
};

TEST_F(TmivInputTest, readsNormalisedDisparityAndTheCamera) {
  writePng(file("v1_texture.png"), kWidth, kHeight, 3, 8, std::vector<uint16_t>(24, 50));
  writePng(file("v1_depth.png"), kWidth, kHeight, 1, 16, {0, 65535, 32768, 1, 2, 3, 4, 5});
  const auto read =
      readInput(settings_, {.color = file("v1_texture.png"), .depth = file("v1_depth.png")});
  EXPECT_EQ(read.how.kind, InputKind::kTmiv) << "--camera says so";
  EXPECT_NEAR(depthAt(read, 0, 0), 25, 1e-3);
  EXPECT_NEAR(depthAt(read, 1, 0), 0.5, 1e-6);
  EXPECT_NEAR(depthAt(read, 2, 0), 1 / (0.04 + (2 - 0.04) * 32768 / 65535), 1e-5);
  const v1::Camera& camera = read.frame.wire.header.sources(0).camera();
  EXPECT_EQ(camera.intrinsics().focal_x_px(), 8);
  EXPECT_EQ(camera.intrinsics().focal_y_px(), 7);
  EXPECT_EQ(camera.intrinsics().principal_x_px(), 2.5);
  // 1 m forward, 2 m to the left, 3 m up; turned to the left by 90 degrees.
  EXPECT_NEAR(camera.pose().position().x(), -2, 1e-12);
  EXPECT_NEAR(camera.pose().position().y(), 3, 1e-12);
  EXPECT_NEAR(camera.pose().position().z(), -1, 1e-12);
  EXPECT_NEAR(camera.pose().orientation().y() * camera.pose().orientation().w(), 0.5, 1e-9);
}

TEST_F(TmivInputTest, takesLevel0AsNothingWhereTheCameraSaysSo) {
  writePng(file("c.png"), kWidth, kHeight, 3, 8, std::vector<uint16_t>(24, 50));
  writePng(file("v0_d.png"), kWidth, kHeight, 1, 16, std::vector<uint16_t>(8, 0));
  EXPECT_TRUE(std::isnan(
      depthAt(readInput(settings_, {.color = file("c.png"), .depth = file("v0_d.png")}), 0, 0)));
}

TEST_F(TmivInputTest, readsFramesOfRawVideo) {
  // 10 bits: white is 940, black 64.
  writeYuv("v1_texture.yuv", {std::vector<uint16_t>(8, 64), std::vector<uint16_t>(8, 940)}, 512);
  writeYuv("v1_depth.yuv", {std::vector<uint16_t>(8, 0), std::vector<uint16_t>(8, 65535)}, 32768);
  const inputs::InputFiles files{
      .color = file("v1_texture.yuv"), .depth = file("v1_depth.yuv"), .view = "", .video_frame = 1};
  const auto read = readInput(settings_, files);
  EXPECT_EQ(read.how.video_frame_count, 2U);
  EXPECT_NEAR(depthAt(read, 3, 1), 0.5, 1e-6);
  EXPECT_EQ(read.frame.wire.planes[0]->front(), 255);
  inputs::InputFiles beyond = files;
  beyond.video_frame = 2;
  EXPECT_THAT(refusalOf(settings_, beyond), HasSubstr("there is none of index 2"));
}

TEST_F(TmivInputTest, turnsVideoRangeToColour) {
  writeYuv("v1_texture.yuv", {std::vector<uint16_t>(8, 502)}, 512);
  std::ofstream(file("v1_texture.yuv"), std::ios::binary | std::ios::in | std::ios::out)
      .seekp(2 * 10)
      .write("\xC0\x03\xC0\x03", 4);  // Cr of 960: as red as can be
  writeYuv("v1_depth.yuv", {std::vector<uint16_t>(8, 9)}, 0);
  const auto read =
      readInput(settings_, {.color = file("v1_texture.yuv"), .depth = file("v1_depth.yuv")});
  // Luma 0.5, Cr 0.5: R = 0.5 + 1.5748 / 2, beyond white; G = 0.5 - 0.4681 / 2; B = 0.5.
  const std::vector<uint8_t>& rgb = *read.frame.wire.planes[0];
  EXPECT_EQ(rgb[0], 255);
  EXPECT_NEAR(rgb[1], 255 * (0.5 - 0.46812 / 2), 1);
  EXPECT_NEAR(rgb[2], 127.5, 1);
}

TEST_F(TmivInputTest, refusesVideoCutShort) {
  writeYuv("v1_texture.yuv", {std::vector<uint16_t>(8, 64)}, 512);
  writeYuv("v1_depth.yuv", {std::vector<uint16_t>(8, 0)}, 0);
  const auto cut = folder_.truncated(file("v1_depth.yuv"), 23);
  std::filesystem::rename(cut, file("v1_cut.yuv"));
  EXPECT_THAT(
      refusalOf(settings_, {.color = file("v1_texture.yuv"), .depth = file("v1_cut.yuv")}),
      HasSubstr("has 23 bytes; accepted are whole frames of 24, which is 4x2 px of 16 bits"));
}

TEST_F(TmivInputTest, namesTheKeyAtFault) {
  const auto refusal = [this](const std::string& more) {
    // If a key occurs twice, the last one counts.
    write(cameraJson("v1", more));
    const auto camera = inputs::readTmivCamera(settings_.camera_file, "", "v1.png");
    return camera.ok() ? "OK" : std::string(camera.status().message());
  };
  EXPECT_EQ(refusal(R"(, "Depth_range": [1, "inf"])"), "OK");
  EXPECT_THAT(refusal(R"(, "Depth_range": [0, 5])"), HasSubstr("Depth_range is [0,5]; accepted"));
  EXPECT_THAT(refusal(R"(, "Depth_range": 5)"), HasSubstr("Depth_range is 5; accepted"));
  EXPECT_THAT(refusal(R"(, "Resolution": [4, 1e300])"), HasSubstr("Resolution is"));
  EXPECT_THAT(refusal(R"(, "Resolution": [9000, 4])"),
              HasSubstr("accepted is [width, height] in px, 1"));
  EXPECT_THAT(refusal(R"(, "Focal": ["a", 2])"), HasSubstr("Focal is [\"a\",2]"));
  EXPECT_THAT(refusal(R"(, "Focal": [0, 2])"), HasSubstr("in px, above 0"));
  EXPECT_THAT(refusal(R"(, "Position": null)"), HasSubstr("Position is null"));
  EXPECT_THAT(refusal(R"(, "BitDepthDepth": 40)"), HasSubstr("BitDepthDepth is 40; accepted"));
  EXPECT_THAT(refusal(R"(, "Projection": "Equirectangular")"), HasSubstr("Perspective"));
  EXPECT_THAT(refusal(R"(, "HasInvalidDepth": 3)"), HasSubstr("true or false"));
  EXPECT_THAT(refusal(R"(, "Focal": )" + std::string(1'000'000, '[')), HasSubstr("deeper than 64"));
  for (const char* name : {"a.png", "c.png"}) {
    writePng(file(name), kWidth, kHeight, 1, 16, std::vector<uint16_t>(8, 50));
  }
  write("[1, 2");
  EXPECT_THAT(refusalOf(settings_, {.color = file("a.png"), .depth = file("c.png")}),
              HasSubstr("is not JSON"));
  write(R"([{"Name": "a"}, {"Name": "b"}])");
  EXPECT_THAT(refusalOf(settings_, {.color = file("a.png"), .depth = file("c.png")}),
              HasSubstr("c.png; it has a, b"));
}

}  // namespace
}  // namespace viewloom::test::tmiv_input_test
