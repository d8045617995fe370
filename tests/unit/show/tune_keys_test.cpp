// SPDX-License-Identifier: Apache-2.0
#include "show/tune_session.h"

#include <SDL_keycode.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace viewloom::show::tune_keys_test {
namespace {

Calibration portrait() {
  return {.pitch = 52.5, .slope = -7.2, .center = 0.4, .dpi = 324, .screen_px = {1536, 2048}};
}

TEST(TuneKeys, turnOneValueEach) {
  Calibration calibration = portrait();
  EXPECT_EQ(applyTuneKey(SDLK_UP, false, calibration), TuneEffect::kRedraw);
  EXPECT_DOUBLE_EQ(calibration.pitch, 52.5005);
  EXPECT_EQ(applyTuneKey(SDLK_LEFT, true, calibration), TuneEffect::kRedraw);
  EXPECT_DOUBLE_EQ(calibration.slope, -7.21);
  EXPECT_EQ(applyTuneKey(SDLK_RIGHTBRACKET, false, calibration), TuneEffect::kRedraw);
  EXPECT_DOUBLE_EQ(calibration.center, 0.402);
  EXPECT_EQ(applyTuneKey(SDLK_z, false, calibration), TuneEffect::kNone);
}

TEST(TuneKeys, goThereAndBack) {
  Calibration calibration = portrait();
  for (const int32_t key :
       {SDLK_UP, SDLK_DOWN, SDLK_LEFT, SDLK_RIGHT, SDLK_LEFTBRACKET, SDLK_RIGHTBRACKET}) {
    applyTuneKey(key, true, calibration);
  }
  EXPECT_NEAR(calibration.pitch, portrait().pitch, 1e-12);
  EXPECT_NEAR(calibration.slope, portrait().slope, 1e-12);
  EXPECT_NEAR(calibration.center, portrait().center, 1e-12);
}

TEST(TuneKeys, neverLeaveWhatACalibrationMayBe) {
  Calibration calibration = portrait();
  calibration.slope = -0.015;
  EXPECT_EQ(applyTuneKey(SDLK_RIGHT, true, calibration), TuneEffect::kNone);
  EXPECT_EQ(calibration.slope, -0.015) << "lenses that lie flat";
}

TEST(TuneKeys, writeOrEnd) {
  Calibration calibration = portrait();
  EXPECT_EQ(applyTuneKey(SDLK_RETURN, false, calibration), TuneEffect::kWrite);
  EXPECT_EQ(applyTuneKey(SDLK_ESCAPE, false, calibration), TuneEffect::kQuit);
  EXPECT_EQ(calibration, portrait());
}

TEST(TuneKeys, areDescribedBesideTheValues) {
  EXPECT_THAT(describeTuning(portrait()), testing::HasSubstr("52.50000  up, down"));
}

}  // namespace
}  // namespace viewloom::show::tune_keys_test
