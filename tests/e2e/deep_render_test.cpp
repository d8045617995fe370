// SPDX-License-Identifier: Apache-2.0
// `viewloom render` on deep files, against what their samples show.
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "deep/tidy_pixel.h"
#include "e2e/run_program.h"
#include "files/png_image.h"
#include "support/deep_composite.h"
#include "support/deep_exr_writer.h"
#include "support/srgb_transfer.h"

namespace viewloom::test::deep_render_test {
namespace {

using deep::DeepPoint;
using deep::DeepSample;
using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr int kWidth = 64, kHeight = 40;
// From 0.1 m to the right, what is at 1 m moves by 4 px, what is at 2 m by 2 px.
constexpr double kFocal_px = 40, kEye_m = 0.1;
constexpr float kDisc_m = 1, kWall_m = 2;
constexpr int kDiscShift_px = 4, kWallShift_px = 2;
// Binary16 and the blend may turn a rounding to 8 bits the other way.
constexpr int kCodesOff = 1;

// A disc with a soft edge, seen through a little, too.
DeepSample disc(int x, int y) {
  const double from_edge_px = 12.3 - std::hypot(x - 31.5, y - 19.5);
  const auto alpha = static_cast<float>(0.9 * std::clamp(0.5 + from_edge_px / 3, 0.0, 1.0));
  return {.z_m = kDisc_m,
          .z_back_m = kDisc_m,
          .alpha = alpha,
          .color = alpha * glm::vec3(0.9F, 0.2F + 0.3F * static_cast<float>(x % 3), 0.1F)};
}

DeepSample wall(int x, int y) {
  const bool is_light = (x / 3 + y / 3) % 2 == 0;
  return {.z_m = kWall_m,
          .z_back_m = kWall_m,
          .alpha = 1,
          .color = is_light ? glm::vec3(0.1F, 0.3F, 0.8F) : glm::vec3(0.02F, 0.1F, 0.05F)};
}

DeepSample fog(float z_m, float z_back_m, float alpha) {
  return {.z_m = z_m, .z_back_m = z_back_m, .alpha = alpha, .color = alpha * glm::vec3(0.6F)};
}

using MakePixel = std::function<DeepPixel(int x, int y)>;
using Shown = std::function<glm::dvec4(int x, int y)>;

// Samples of no alpha and light are left out, as renderers do.
DeepPixel withoutNothing(DeepPixel pixel) {
  std::erase_if(pixel, [](const DeepSample& sample) { return sample.alpha == 0; });
  return pixel;
}

glm::dvec4 flat(const DeepPixel& pixel) {
  deep::PixelTidier tidier;
  return deep::compositeOf(tidier.tidy(pixel));
}

Json camera(double x_m) {
  return {{"pose", {{"position", {{"x", x_m}}}}},
          {"intrinsics",
           {{"focalXPx", kFocal_px},
            {"focalYPx", kFocal_px},
            {"principalXPx", kWidth / 2},
            {"principalYPx", kHeight / 2}}}};
}

class DeepRenderTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  // Renders the file from its own place and from kEye_m to the right.
  Json render(const MakePixel& make, const Json& options, const DeepFileOptions& file = {}) {
    DeepPicture picture;
    picture.data = picture.display = {{0, 0}, {kWidth - 1, kHeight - 1}};
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) picture.pixels.push_back(withoutNothing(make(x, y)));
    }
    writeDeepExr(folder_ / "deep.exr", picture, file);
    Json deep = options;
    deep["file"] = "deep.exr";
    deep["depth"] = {{"meaning", "DEPTH_MEANING_PLANAR"}};
    // With two depths alone, the step between them would be measured as that of the samples.
    const Json source = {{"camera", camera(0)}, {"deep", deep}, {"connectionTolerance", 0.01}};
    write("frame.json", {{"sources", {source}}});
    write("display.json", {{"cameras",
                            {{"columns", 2},
                             {"tileSize", {{"width", kWidth}, {"height", kHeight}}},
                             {"cameras", {camera(0), camera(kEye_m)}}}}});
    const std::string prefix = folder_.string() + "/";
    const FinishedRun run = runViewloom("render --frame " + prefix + "frame.json --display " +
                                        prefix + "display.json --out " + prefix + "out");
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    return Json::parse(run.output).at("deep").at(0);
  }

  // The largest difference of a view to what it should show, codes, over columns begin..end-1.
  int codesOff(const std::string& view, int begin, int end, const Shown& shown) const {
    const auto image = files::readPngColor(folder_ / "out" / view, false);
    EXPECT_TRUE(image.ok()) << image.status();
    int most = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = begin; x < end; ++x) {
        const glm::dvec4 wanted = shown(x, y);
        for (int c = 0; c < 3; ++c) {
          const auto code = static_cast<int>(std::lround(255 * srgbFrom(wanted[c])));
          const int got = image->bytes[static_cast<size_t>(3 * (y * kWidth + x) + c)];
          most = std::max(most, std::abs(got - code));
        }
      }
    }
    return most;
  }

  void write(const std::string& name, const Json& json) const {
    std::ofstream(folder_ / name) << json.dump();
  }

  const fs::path folder_ =
      fs::temp_directory_path() / ("viewloom_deep_" + std::to_string(getpid()));
};

TEST_F(DeepRenderTest, showsWhatIsBehindASoftEdgeFromItsOwnPlaceAndBeside) {
  const MakePixel scene = [](int x, int y) { return DeepPixel{wall(x, y), disc(x, y)}; };
  const Shown own = [&](int x, int y) { return flat(scene(x, y)); };
  const Shown beside = [](int x, int y) {
    return flat({wall(x + kWallShift_px, y), disc(x + kDiscShift_px, y)});
  };
  const Json report = render(scene, Json::object(), {.tile_side_px = 16});
  EXPECT_EQ(report.at("layers"), 2);
  EXPECT_EQ(report.at("merged"), 0);
  EXPECT_EQ(report.at("error_max_per_m"), 0);
  EXPECT_LE(codesOff("view_000.png", 0, kWidth, own), kCodesOff);
  EXPECT_LE(codesOff("view_001.png", 0, kWidth - kDiscShift_px, beside), kCodesOff);

  // In one layer, it is the same picture from its own place, and another one beside.
  const Json merged = render(scene, {{"layers", 1}});
  EXPECT_EQ(merged.at("layers"), 1);
  EXPECT_GT(merged.at("merged").get<double>(), 0.1);
  // Where the disc covers half: half at 1/Z = 1, half at 1/2.
  EXPECT_GT(merged.at("error_max_per_m").get<double>(), 0.24);
  EXPECT_LE(merged.at("error_max_per_m").get<double>(), 0.25);
  EXPECT_LE(codesOff("view_000.png", 0, kWidth, own), kCodesOff);
  EXPECT_GT(codesOff("view_001.png", 0, kWidth - kDiscShift_px, beside), 50);
}

TEST_F(DeepRenderTest, showsAThingBeforeNothingBeforeABlackSky) {
  const MakePixel scene = [](int x, int y) { return DeepPixel{disc(x, y)}; };
  const Json report = render(scene, {{"blackSky", true}});
  EXPECT_EQ(report.at("layers"), 2);
  EXPECT_LE(codesOff("view_000.png", 0, kWidth, [&](int x, int y) { return flat(scene(x, y)); }),
            kCodesOff);
  EXPECT_LE(codesOff("view_001.png", 0, kWidth - kDiscShift_px,
                     [&](int x, int y) { return flat(scene(x + kDiscShift_px, y)); }),
            kCodesOff);
}

TEST_F(DeepRenderTest, showsAThingInFogFromItsOwnPlace) {
  const MakePixel scene = [](int x, int y) {
    return DeepPixel{wall(x, y), fog(0.5F, 1.5F, 0.4F), disc(x, y),
                     fog(1.25F, 2, 0.1F + 0.01F * static_cast<float>(x))};
  };
  const Json report = render(scene, Json::object(), {.compression = Imf::RLE_COMPRESSION});
  EXPECT_EQ(report.at("layers"), 4);
  EXPECT_EQ(report.at("samples_per_px_max"), 4);
  EXPECT_EQ(report.at("merged"), 1);
  EXPECT_GT(report.at("error_mean_per_m").get<double>(), 0);
  EXPECT_LE(codesOff("view_000.png", 0, kWidth, [&](int x, int y) { return flat(scene(x, y)); }),
            kCodesOff);
}

TEST_F(DeepRenderTest, refusesADeepFileByFieldAndFile) {
  write("frame.json", {{"sources", {{{"deep", {{"file", "none.exr"}, {"layers", 9}}}}}}});
  write("display.json", Json::object());
  const std::string prefix = folder_.string() + "/";
  const FinishedRun run = runViewloom("render --frame " + prefix + "frame.json --display " +
                                      prefix + "display.json --out " + prefix + "out");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.errors, testing::HasSubstr("frame.json.sources[0].deep.layers: is 9"));
}

}  // namespace
}  // namespace viewloom::test::deep_render_test
