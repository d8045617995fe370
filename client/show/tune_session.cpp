// SPDX-License-Identifier: Apache-2.0
#include "show/tune_session.h"

#include <SDL.h>
#include <SDL_keycode.h>

#include <cstdio>
#include <utility>

#include "base/str_cat.h"
#include "files/file_bytes.h"
#include "show/painter.h"
#include "show/stage.h"

namespace viewloom::show {
namespace {

constexpr int kTick_ms = 50;  // interrupts come without an event

absl::Status drawPattern(const Calibration& calibration, Stage& stage, TextOverlay& overlay) {
  stage.painter->begin(stage.window->sizePx());
  stage.painter->tune(calibration);
  VIEWLOOM_RETURN_IF_ERROR(overlay.draw(describeTuning(calibration), *stage.painter));
  stage.window->swap();
  return absl::OkStatus();
}

// Whether it is written; what was tuned is not lost on a full disk.
bool writeTuned(const Calibration& calibration, const TuneOptions& options,
                const TuneCallbacks& callbacks) {
  const absl::Status written = files::writeFileWhole(options.out, writeCalibration(calibration));
  const std::string file = options.out.string();
  callbacks.say(written.ok() ? strCat("wrote ", file, "; show with it: --calibration ", file)
                             : strCat(std::string(written.message()), "; nothing is lost yet"));
  return written.ok();
}

// Effect of an event on the calibration and the window.
TuneEffect effectOf(const SDL_Event& event, Calibration& calibration) {
  if (event.type == SDL_QUIT) return TuneEffect::kQuit;
  if (event.type == SDL_WINDOWEVENT) return TuneEffect::kRedraw;
  if (event.type != SDL_KEYDOWN) return TuneEffect::kNone;
  const bool is_coarse = (event.key.keysym.mod & KMOD_SHIFT) != 0;
  return applyTuneKey(event.key.keysym.sym, is_coarse, calibration);
}

}  // namespace

absl::Status tunePanel(const TuneOptions& options, const TuneCallbacks& callbacks) {
  const SizePx panel_px = options.calibration.screen_px;
  absl::StatusOr<Stage> stage = openStage({.title = "viewloom: tune",
                                           .monitor = options.monitor,
                                           .is_windowed = options.is_windowed,
                                           .windowed_px = panel_px,
                                           .panel_px = panel_px},
                                          callbacks.say);
  if (!stage.ok()) return stage.status();
  const absl::StatusOr<std::unique_ptr<TextOverlay>> overlay = TextOverlay::make();
  if (!overlay.ok()) return overlay.status();
  Calibration calibration = options.calibration;
  bool is_stale = true;
  while (!callbacks.is_interrupted()) {
    if (std::exchange(is_stale, false)) {
      VIEWLOOM_RETURN_IF_ERROR(drawPattern(calibration, *stage, **overlay));
    }
    SDL_Event event;
    if (SDL_WaitEventTimeout(&event, kTick_ms) == 0) continue;
    const TuneEffect effect = effectOf(event, calibration);
    if (effect == TuneEffect::kWrite && writeTuned(calibration, options, callbacks)) {
      return absl::OkStatus();
    }
    if (effect == TuneEffect::kQuit) break;
    is_stale = effect == TuneEffect::kRedraw;
  }
  callbacks.say("ended; nothing was written");
  return absl::OkStatus();
}

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
