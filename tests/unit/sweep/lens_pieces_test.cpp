// SPDX-License-Identifier: Apache-2.0
// The rays of panels in pieces, beside the ray of every subpixel by itself: from the eye that its
// place under its lens says, binary64.
#include "sweep/lens_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "calibration/make_lenticular.h"
#include "display/presets.h"

namespace viewloom::lens_pieces_test {
namespace {

constexpr SizePx kSource_px{960, 540};
constexpr Camera kSource{.pose = {}, .intrinsics = {{831, 831}, {480, 270}}};
constexpr double kInvZMax = 0.5;  // 1/m
constexpr double kFocus_m = 3;

TraceJob jobOf(const LenticularSpec& lenticular, const RayFilter& filter = {}) {
  const DisplaySpec spec = completeDisplaySpec({.kind = lenticular, .filter = filter}).value();
  const StreamDefaults defaults{.source_intrinsics = kSource.intrinsics,
                                .source_size_px = kSource_px,
                                .focal_distance_m = kFocus_m};
  return makeTraceJob(std::make_shared<const AtlasLayout>(makeAtlasLayout(spec, defaults).value()),
                      spec, displayPose(spec, kSource), kSource, kSource_px);
}

struct Panel {
  std::string name;
  Calibration calibration;
  uint32_t view_count = 0;
  double cone_rad = 0;  // 0 = the calibration's
};

std::vector<Panel> panels() {
  const Calibration portrait = panelOfPreset("portrait").value();
  const Calibration cells = panelOfPreset("16_gen3_l").value();
  Calibration chequered = portrait;
  chequered.cell_pattern_mode = abi::kCellsChequered;
  chequered.cells = {{.red = {-0.3, 0.2}, .green = {0, -0.1}, .blue = {0.3, 0.2}},
                     {.red = {0.3, -0.2}, .green = {0.1, 0.1}, .blue = {-0.3, -0.2}}};
  Calibration turned = portrait;
  turned.pitch = -turned.pitch;
  turned.inv_view = false;
  Calibration coarse = portrait;
  coarse.pitch *= 2.4999;  // 2.5 px a lens
  return {{"portrait", portrait},
          {"16_gen3_l", cells},
          {"nearest of 45", portrait, 45},
          {"nearest of 3", cells, 3},
          {"cells by column and row", chequered},
          {"from the other side", turned},
          {"coarse", coarse},
          {"wide", portrait, 0, 2.0}};
}

class LensPiecesOf : public testing::TestWithParam<size_t> {
 protected:
  void SetUp() override {
    const Panel panel = panels()[GetParam()];
    SCOPED_TRACE(panel.name);
    lenticular_.calibration_json = writeCalibration(panel.calibration);
    lenticular_.view_count = panel.view_count;
    lenticular_.view_cone_rad = panel.cone_rad;
    job_ = jobOf(lenticular_);
    rays_ = std::get<LenticularRays>(job_.layout->rays);
    pieces_ = LensPieces::make(job_, kInvZMax);
    ASSERT_TRUE(pieces_.has_value());
  }

  // Where in the source the ray of a subpixel is.
  double placeOf(uint32_t x, uint32_t y, uint32_t channel, double inv_z) const {
    const abi::Lenticular lens = makeLenticular(rays_.calibration);
    const float coordinate = abi::viewCoordinate(lens, x, y, channel);
    double place = double{coordinate};
    if (rays_.view_count > 0) {
      place = (abi::nearestView(coordinate, rays_.view_count) + 0.5) / rays_.view_count;
    }
    const double eye_m = rays_.distance_m * std::tan(rays_.view_cone_rad * (place - 0.5));
    // The px on the focal plane that the view from the middle shows there.
    const Intrinsics& middle = job_.layout->views.front().camera.intrinsics;
    const double at_focus_m =
        rays_.distance_m * (x + 0.5 - middle.principal_px.x) / middle.focal_px.x;
    // From the eye through it to where inv_z is that of the source's depth.
    const double along = eye_m * inv_z + (at_focus_m - eye_m) / rays_.distance_m;
    return kSource.intrinsics.principal_px.x + kSource.intrinsics.focal_px.x * along;
  }

  double pixel() const {
    return kSource.intrinsics.focal_px.x / job_.layout->views.front().camera.intrinsics.focal_px.x;
  }

  LenticularSpec lenticular_;
  TraceJob job_;
  LenticularRays rays_;
  std::optional<LensPieces> pieces_;
};

INSTANTIATE_TEST_SUITE_P(Panels, LensPiecesOf, testing::Range(size_t{0}, panels().size()));

TEST_P(LensPiecesOf, showEverySubpixelOnceFromWhereItsLensSendsIt) {
  const SizePx panel_px = job_.layout->size_px;
  // Rounding error of binary32 at a thousand px.
  constexpr double kRounding_px = 1e-3;
  const double error_max_px =
      LensPieces::kEyeErrorShare * job_.tolerance_px * pixel() + kRounding_px;
  std::vector<LensPiece> row;
  for (const uint32_t y : {0U, 1U, 2U, 3U, panel_px.height / 2, panel_px.height - 1}) {
    for (uint32_t sample = 0; sample < 3; ++sample) {
      row.clear();
      pieces_->appendRow(y, sample, row);
      std::vector<int> shown(panel_px.width);
      double error_px = 0;
      for (const LensPiece& piece : row) {
        for (uint32_t p = 0; p < piece.count; ++p) {
          const uint32_t x = piece.first_px + p * piece.stride_px;
          ASSERT_LT(x, panel_px.width);
          ++shown[x];
          for (const double inv_z : {0.0, 1 / kFocus_m, kInvZMax}) {
            const double expected = placeOf(x, y, pieces_->channelOf(sample), inv_z);
            const double got = double{piece.view.placeAt(float(p), float(inv_z))};
            error_px = std::max(error_px, std::abs(got - expected));
          }
        }
      }
      EXPECT_LE(error_px, error_max_px) << "row " << y << ", sample " << sample;
      EXPECT_TRUE(std::ranges::all_of(shown, [](int count) { return count == 1; }));
    }
  }
}

TEST_P(LensPiecesOf, goOneWayAlongTheRowAndFromOneSide) {
  std::vector<LensPiece> row;
  for (uint32_t sample = 0; sample < 3; ++sample) pieces_->appendRow(77, sample, row);
  for (const LensPiece& piece : row) {
    const float last = float(piece.count - 1);
    EXPECT_GE(piece.view.eyeAt(0) * piece.view.eyeAt(last), 0);
    EXPECT_LE(std::abs(piece.view.eyeAt(last)), pieces_->pxPerInvZ() * 1.001F);
    for (uint32_t p = 1; p < piece.count; ++p) {
      EXPECT_GE(piece.view.eyeAt(float(p)) * piece.view.eyeAt(last), 0);
      for (const float inv_z : {0.0F, float(kInvZMax)}) {
        EXPECT_GT(piece.view.placeAt(float(p), inv_z), piece.view.placeAt(float(p - 1), inv_z));
      }
    }
  }
}

size_t countPieces(uint32_t view_count) {
  LenticularSpec lenticular;
  lenticular.calibration_json = writeCalibration(panelOfPreset("portrait").value());
  lenticular.view_count = view_count;
  const LensPieces pieces = LensPieces::make(jobOf(lenticular), kInvZMax).value();
  std::vector<LensPiece> row;
  for (uint32_t sample = 0; sample < 3; ++sample) pieces.appendRow(1000, sample, row);
  return row.size();
}

// A piece costs a look at all surfaces of a row. Measured: 323 of the 4608 subpixels of a Portrait.
TEST(LensPieces, areFewWhereLensesNearlyRepeat) {
  EXPECT_LE(countPieces(0), 400U);
}

// One that goes on in the next view costs little more than one of a single view. Measured: 329 of 8
// views, and 346, 323 and 323.
TEST(LensPieces, areHardlyMoreOfManyViews) {
  const size_t of_few = countPieces(8);
  for (const uint32_t view_count : {24U, 48U, 96U}) {
    EXPECT_LE(double(countPieces(view_count)), 1.1 * double(of_few)) << view_count << " views";
  }
}

TEST(LensPieces, areNotThoseOfFilteredPanelsAndOtherDisplays) {
  LenticularSpec lenticular;
  lenticular.calibration_json = writeCalibration(panelOfPreset("portrait").value());
  EXPECT_FALSE(LensPieces::make(jobOf(lenticular, {.sample_count = 2}), kInvZMax).has_value());
}

}  // namespace
}  // namespace viewloom::lens_pieces_test
