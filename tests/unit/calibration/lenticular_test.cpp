// SPDX-License-Identifier: Apache-2.0
#include "shared/lenticular.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/make_lenticular.h"
#include "unit/calibration/device_files.h"

namespace viewloom::lenticular_test {
namespace {

// The formula that makers of players agree on, in binary64 and term by term.
struct Reference {
  Calibration file;

  uint32_t cellAt(uint32_t x, uint32_t y) const {
    const uint32_t cells[] = {0, (x + y) % 2, x % 2, (y + 2 * (x % 2)) % 4, y % 2};
    return cells[file.cell_pattern_mode] % static_cast<uint32_t>(file.cells.size());
  }

  // Place under its lens, in lens widths, [0, 1). y counts from the bottom.
  double z(uint32_t x, uint32_t y, uint32_t channel) const {
    const double width = file.screen_px.width;
    const double height = file.screen_px.height;
    const double flip = file.flip_x ? -1 : 1;
    const double lenses = file.pitch * width / file.dpi * std::cos(std::atan(1 / file.slope));
    const double tilt = height / (width * file.slope) * flip;
    const double u = (x + 0.5) / width;
    const double v = (y + 0.5) / height;
    const uint32_t at = file.flip_subpixels ? 2 - channel : channel;
    double a = at / (3 * width) * flip;
    double b = 0;
    if (!file.cells.empty()) {
      const SubpixelCell& cell = file.cells[cellAt(x, y)];
      const SubpixelOffset offsets[] = {cell.red, cell.green, cell.blue};
      a = offsets[at].x_px / width;
      b = offsets[at].y_px / height;
    }
    const double phase = ((u + a) + (v + b) * tilt) * lenses - file.center;
    return phase - std::floor(phase);
  }

  double view(uint32_t x, uint32_t y, uint32_t channel) const {
    return file.inv_view ? 1 - z(x, y, channel) : z(x, y, channel);
  }
};

// Views follow one another in a circle, from lens to lens.
double distance(double a, double b) {
  const double apart = std::abs(a - b);
  return std::min(apart, 1 - apart);
}

double largestError(const Calibration& file, int samples, std::mt19937& random) {
  const Reference reference{file};
  const abi::Lenticular lens = makeLenticular(file);
  std::uniform_int_distribution<uint32_t> column(0, file.screen_px.width - 1);
  std::uniform_int_distribution<uint32_t> row(0, file.screen_px.height - 1);
  double largest = 0;
  for (int i = 0; i < samples; ++i) {
    const uint32_t x = column(random);
    const uint32_t y = row(random);
    for (uint32_t channel = 0; channel < 3; ++channel) {
      const float got = abi::viewCoordinate(lens, x, file.screen_px.height - 1 - y, channel);
      EXPECT_GE(got, 0);
      EXPECT_LT(got, 1);
      largest = std::max(largest, distance(got, reference.view(x, y, channel)));
    }
  }
  return largest;
}

constexpr unsigned kSeed = 20260722;

TEST(Lenticular, agreesWithTheFormulaOnTheDevicesFiles) {
  std::mt19937 random(kSeed);
  for (const std::string_view file : {kPortraitFile, kThirdGenerationFile}) {
    EXPECT_LT(largestError(*parseCalibration(file), 20000, random), 2e-6) << file;
  }
}

TEST(Lenticular, agreesWithTheFormulaInEveryPatternAndFlip) {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> offset(-0.5, 0.5);
  for (uint32_t choice = 0; choice < 5 * 5 * 8; ++choice) {
    Calibration file = *parseCalibration(kThirdGenerationFile);
    file.cell_pattern_mode = choice % 5;
    file.cells.clear();
    for (uint32_t cell = 0; cell < choice / 5 % 5; ++cell) {
      file.cells.push_back({{offset(random), offset(random)},
                            {offset(random), offset(random)},
                            {offset(random), offset(random)}});
    }
    file.flip_x = (choice / 25 & 1) != 0;
    file.inv_view = (choice / 25 & 2) != 0;
    file.flip_subpixels = (choice / 25 & 4) != 0;
    EXPECT_LT(largestError(file, 200, random), 5e-6) << "choice " << choice << ", seed " << kSeed;
  }
}

TEST(Lenticular, agreesWithTheFormulaOnTheLargestPanels) {
  std::mt19937 random(kSeed);
  for (const double slope : {-6.3, 5.04, 0.05, -1000.0}) {
    for (const double pitch : {20.0, 80.7, -50.0}) {
      Calibration file = *parseCalibration(kPortraitFile);
      file.screen_px = {16384, 16384};
      file.dpi = 200;
      file.pitch = pitch;
      file.slope = slope;
      EXPECT_LT(largestError(file, 5000, random), 1e-5)
          << "pitch " << pitch << ", slope " << slope << ", seed " << kSeed;
    }
  }
}

struct Golden {
  Calibration file;
  double lenses;
  double tilt;
};

TEST(Lenticular, hasThePublishedLensesAndTilts) {
  const Golden goldens[] = {
      {{.pitch = 52.563010659943416,
        .slope = -7.244674277559994,
        .center = 0.4016996953176948,
        .dpi = 324,
        .screen_px = {1536, 2048}},
       246.847119,
       -0.1840432},
      {*parseCalibration(kThirdGenerationFile), 600.892323, -0.0818234},
      {{.pitch = 49.81804275512695,
        .slope = 5.044347763061523,
        .center = 0.176902174949646,
        .dpi = 338,
        .screen_px = {2560, 1600}},
       370.117407,
       0.1239011},
  };
  for (const Golden& golden : goldens) {
    EXPECT_NEAR(lensCount(golden.file), golden.lenses, 5e-7);
    EXPECT_NEAR(lensTilt(golden.file), golden.tilt, 5e-8);
  }
}

TEST(Lenticular, hasThePublishedPhaseInTheMiddleOfAPortrait) {
  const Golden portrait = {{.pitch = 52.563010659943416,
                            .slope = -7.244674277559994,
                            .center = 0.4016996953176948,
                            .dpi = 324,
                            .screen_px = {1536, 2048}},
                           246.847119,
                           -0.1840432};
  // Published for green at u = v = 1/2; the middle of the panel is a corner of four px.
  const abi::Lenticular lens = makeLenticular(portrait.file);
  const double from_corner = (0.5 / 1536 + 0.5 / 2048 * portrait.tilt) * portrait.lenses;
  EXPECT_NEAR(1 - abi::viewCoordinate(lens, 768, 1023, 1) - from_corner, 0.360157, 2e-6);
}

TEST(Lenticular, turnsTiltAroundWithTheImage) {
  Calibration file = *parseCalibration(kPortraitFile);
  const double tilt = lensTilt(file);
  file.flip_x = true;
  EXPECT_EQ(lensTilt(file), -tilt);
}

TEST(Lenticular, givesTheLastViewWhereAnInvertedPhaseIsZero) {
  const abi::Lenticular lens{.height_px = 1, .cell_count = 1, .is_inverted = 1};
  EXPECT_EQ(abi::viewCoordinate(lens, 0, 0, 0), 1 - std::ldexp(1.0f, -24));
  EXPECT_EQ(abi::nearestView(abi::viewCoordinate(lens, 0, 0, 0), 48), 47u);
}

TEST(NearestView, sharesTheConeEvenlyAndNeverRunsOver) {
  for (const uint32_t count : {1u, 3u, 45u, 48u, 49u, 66u, 2500u}) {
    EXPECT_EQ(abi::nearestView(0, count), 0u);
    EXPECT_EQ(abi::nearestView(1 - std::ldexp(1.0f, -24), count), count - 1);
    for (uint32_t view = 0; view < count; ++view) {
      const double middle = (view + 0.5) / count;
      EXPECT_EQ(abi::nearestView(static_cast<float>(middle), count), view) << "of " << count;
    }
  }
}

}  // namespace
}  // namespace viewloom::lenticular_test
