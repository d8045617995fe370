// SPDX-License-Identifier: Apache-2.0
// A scene in files that are written wrongly, and what is suspected in them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "cli/option_trial.h"
#include "cli/plane_options.h"
#include "inspect/inspection.h"
#include "unit/client/test_files.h"
#include "unit/inputs/written_files.h"

namespace viewloom::test {

using cli::FrameFiles;
using inspect::LayerInspection;

inline constexpr int kWidth = 96, kHeight = 64;
inline constexpr float kInf = std::numeric_limits<float>::infinity();

// A wall at 4 m behind a board at 1.5 m and another at 2.5 m, on a level floor.
inline float roomAt(int x, int y) {
  if (x >= 15 && x < 40 && y >= 8 && y < 30) return 1.5F;
  if (x >= 60 && x < 75 && y >= 25 && y < 45) return 2.5F;
  return y < 44 ? 4 : 1 / (0.25F + 0.025F * float(y - 43));
}
inline bool isNothing(int x, int y) {
  return y < 5 && x > 70;
}

class WrongFilesTest : public ::testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  FrameFiles exr(const std::function<float(int x, int y)>& z, float alpha = 1) const {
    return exr(
        z, [](int x, int y) { return 0.2F + 0.001F * float(x + y); }, alpha);
  }
  FrameFiles exr(const std::function<float(int x, int y)>& z,
                 const std::function<float(int x, int y)>& grey, float alpha = 1) const {
    writeExr(file("scene.exr"), kWidth, kHeight,
             {{"R", Imf::HALF, grey},
              {"G", Imf::HALF, grey},
              {"B", Imf::HALF, grey},
              {"A", Imf::HALF, [alpha](int, int) { return alpha; }},
              {"Z", Imf::FLOAT, z}});
    return {.manifest = {}, .deep = {}, .input = {.color = file("scene.exr")}};
  }

  FrameFiles pair(uint32_t bits, const std::function<double(int x, int y)>& code) const {
    std::vector<uint16_t> codes;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) codes.push_back(uint16_t(std::lround(code(x, y))));
    }
    writePng(file("color.png"), kWidth, kHeight, 3, 8,
             std::vector<uint16_t>(3 * kWidth * kHeight, 90));
    writePng(file("depth.png"), kWidth, kHeight, 1, bits, codes);
    return {.manifest = {},
            .deep = {},
            .input = {.color = file("color.png"), .depth = file("depth.png")}};
  }

  static cli::LoaderOptions withOptions(const std::string& options) {
    cli::LoaderOptions loader;
    const usage::CommandLine app;
    cli::addPlaneOptions(app, loader.input);
    EXPECT_TRUE(options.empty() || app.parse(options)) << options;
    return loader;
  }

  // Its first layer, remedies filled in.
  static LayerInspection inspected(const FrameFiles& files, const std::string& options = "") {
    const cli::LoaderOptions loader = withOptions(options);
    const auto loaded = cli::FrameLoader(loader).load(files);
    EXPECT_TRUE(loaded.ok()) << loaded.status();
    if (!loaded.ok()) return {};
    auto sources = inspect::inspectFrame(loaded->frame);
    EXPECT_TRUE(sources.ok()) << sources.status();
    if (!sources.ok()) return {};
    cli::tryRemedies(cli::OptionTrial(files, loader), *sources);
    return std::move(sources->front().layers.front());
  }

  // The options in "... try OPTIONS (...): ..." of the suspicion.
  static std::string remedyOf(const LayerInspection& layer, const std::string& kind) {
    for (const inspect::Suspicion& suspicion : layer.suspicions) {
      if (suspicion.kind != kind) continue;
      const std::string& remedy = suspicion.remedy;
      if (!remedy.starts_with("try ")) return remedy;
      return remedy.substr(4, std::min(remedy.find(" ("), remedy.find(": ")) - 4);
    }
    return "not suspected";
  }

  static double rangeError(const LayerInspection& layer, double near_m, double far_m) {
    return std::abs(1 / double{layer.measures.inv_z_max} - near_m) / near_m +
           std::abs(1 / double{layer.measures.inv_z_min} - far_m) / far_m;
  }

  const files::TestFolder folder_;
};

}  // namespace viewloom::test
