// SPDX-License-Identifier: Apache-2.0
#include "show/tune_keys.h"

#include <SDL_keycode.h>

#include <cstdio>

namespace viewloom::show {
namespace {

// An eye tells a 50th of a lens across a panel: a few of these steps.
constexpr double kPitchStep = 0.0005;
constexpr double kSlopeStep = 0.001;
constexpr double kCenterStep = 0.002;
constexpr double kCoarse = 10;

TuneEffect turn(double Calibration::*value, double by, Calibration& calibration) {
  Calibration turned = calibration;
  turned.*value += by;
  if (!parseCalibration(writeCalibration(turned)).ok()) return TuneEffect::kNone;
  calibration = turned;
  return TuneEffect::kRedraw;
}

}  // namespace

TuneEffect applyTuneKey(int32_t sdl_key, bool is_coarse, Calibration& calibration) {
  const double steps = is_coarse ? kCoarse : 1;
  switch (sdl_key) {
    case SDLK_UP:
      return turn(&Calibration::pitch, steps * kPitchStep, calibration);
    case SDLK_DOWN:
      return turn(&Calibration::pitch, -steps * kPitchStep, calibration);
    case SDLK_RIGHT:
      return turn(&Calibration::slope, steps * kSlopeStep, calibration);
    case SDLK_LEFT:
      return turn(&Calibration::slope, -steps * kSlopeStep, calibration);
    case SDLK_RIGHTBRACKET:
      return turn(&Calibration::center, steps * kCenterStep, calibration);
    case SDLK_LEFTBRACKET:
      return turn(&Calibration::center, -steps * kCenterStep, calibration);
    case SDLK_RETURN:
    case SDLK_s:
      return TuneEffect::kWrite;
    case SDLK_ESCAPE:
    case SDLK_q:
      return TuneEffect::kQuit;
    default:
      return TuneEffect::kNone;
  }
}

std::string describeTuning(const Calibration& calibration) {
  char text[400];
  std::snprintf(text, sizeof(text),
                "pitch  %10.5f  up, down\n"
                "slope  %10.5f  left, right\n"
                "centre %10.5f  [ ]\n"
                "shift: ten steps; enter writes, escape ends\n"
                "right when each eye sees one colour all over",
                calibration.pitch, calibration.slope, calibration.center);
  return text;
}

}  // namespace viewloom::show
