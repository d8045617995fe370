// SPDX-License-Identifier: Apache-2.0
// A folder with a scene for viewloom render: a noisy wall at 2 m, and a noisy square at 1 m.
// Its display has two views: from the source's place, and from 0.1 m to the right.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/str_cat.h"
#include "e2e/run_program.h"
#include "files/file_bytes.h"
#include "files/png_image.h"

namespace viewloom::test {

namespace fs = std::filesystem;

inline constexpr uint32_t kWidth = 48;
inline constexpr uint32_t kHeight = 32;
inline constexpr uint32_t kSquareLeft = 16;
inline constexpr uint32_t kSquareTop = 10;
inline constexpr uint32_t kSquareSide = 12;

class RenderTest : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_);
    std::vector<uint8_t> color;
    for (uint32_t i = 0; i < kWidth * kHeight * 3; ++i)
      color.push_back(uint8_t(i * i * 7 + i * 31));
    writePng("color.png", color, 3);
    writeDepth("depth.pfm", kSquareLeft);
    write("frame.json", frameJson("color.png"));
    write("display.json",
          R"({"cameras":{"columns":2,"tileSize":{"width":48,"height":32},"cameras":[)" +
              cameraJson(0) + "," + cameraJson(0.1) + "]}}");
    write("truth.json", R"({"views":[{"viewIndex":0,"color":{"file":"color.png"}}]})");
  }
  void TearDown() override { fs::remove_all(folder_); }

  static bool isSquare(uint32_t x, uint32_t y, uint32_t left) {
    return x >= left && x < left + kSquareSide && y >= kSquareTop && y < kSquareTop + kSquareSide;
  }

  std::string cameraJson(double x_m) const {
    return R"({"pose":{"position":{"x":)" + std::to_string(x_m) + R"(}},"intrinsics":)" +
           kIntrinsics + "}";
  }
  std::string layerJson(const std::string& color_file, const std::string& depth_file) const {
    return R"("color":{"file":")" + color_file + R"("},"depth":{"file":")" + depth_file +
           R"(","depth":{"meaning":"DEPTH_MEANING_PLANAR"}})";
  }
  std::string sourcesJson(double x_m, const std::string& layer) const {
    return R"("sources":[{"camera":)" + cameraJson(x_m) + R"(,"layers":[{)" + layer + "}]}]";
  }
  std::string frameJson(const std::string& color_file) const {
    return strCat("{", sourcesJson(0, layerJson(color_file, "depth.pfm")), "}");
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  }
  void writePng(const std::string& name, const std::vector<uint8_t>& samples, uint32_t channels) {
    const auto png = files::encodePng(samples, kWidth, kHeight, channels);
    ASSERT_TRUE(png.ok()) << png.status();
    ASSERT_TRUE(files::writeFileWhole(folder_ / name, *png).ok());
  }
  // Bottom row first. `channels`: 1 or 3.
  void writePfm(const std::string& name, const std::vector<float>& samples, uint32_t channels) {
    std::ofstream pfm(folder_ / name, std::ios::binary);
    pfm << (channels == 1 ? "Pf\n" : "PF\n") << kWidth << " " << kHeight << "\n-1\n";
    pfm.write(reinterpret_cast<const char*>(samples.data()),
              std::streamsize(samples.size() * sizeof(float)));
  }
  // The square is as far from the lower edge as from the upper one.
  void writeDepth(const std::string& name, uint32_t left) {
    std::vector<float> depth_m;
    for (uint32_t i = 0; i < kWidth * kHeight; ++i) {
      depth_m.push_back(isSquare(i % kWidth, i / kWidth, left) ? 1 : 2);
    }
    writePfm(name, depth_m, 1);
  }
  FinishedRun render(const std::string& frame, const std::string& display,
                     const std::string& flags) {
    const std::string prefix = folder_.string() + "/";
    return runViewloom("render --frame " + prefix + frame + " --display " + prefix + display +
                       " --out " + prefix + "out " + flags);
  }

  // The newest rendered picture of one view.
  std::vector<uint8_t> picture(uint32_t view = 0) const {
    const std::string name = strCat("view_00", view, ".png");
    const auto png = files::readPngColor(folder_ / "out" / name, false);
    EXPECT_TRUE(png.ok()) << png.status();
    return png.ok() ? png->bytes : std::vector<uint8_t>(4 * kWidth * kHeight);
  }
  static int codeAt(const std::vector<uint8_t>& picture, uint32_t x, uint32_t y,
                    uint32_t channel = 0) {
    return picture.at(picture.size() / (kWidth * kHeight) * (y * kWidth + x) + channel);
  }

  const std::string kIntrinsics =
      R"({"focalXPx":40,"focalYPx":40,"principalXPx":24,"principalYPx":16})";
  const fs::path folder_ =
      fs::temp_directory_path() / ("viewloom_render_" + std::to_string(getpid()));
};

}  // namespace viewloom::test
