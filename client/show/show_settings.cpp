// SPDX-License-Identifier: Apache-2.0
#include "show/show_settings.h"

#include <SDL_keycode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace viewloom::show {
namespace {

constexpr double kStep = 1.05;  // of focus and cone, from key to key
// Range that the API takes.
constexpr double kFocusMin_m = 1e-6;
constexpr double kFocusMax_m = 1e9;
constexpr double kConeMin_rad = 0.001;
constexpr double kConeMax_rad = 2.6;

constexpr std::array<std::pair<ShowMode, std::string_view>, 5> kModes = {{
    {ShowMode::kNative, "native"},
    {ShowMode::kWeave, "weave"},
    {ShowMode::kView, "view"},
    {ShowMode::kPair, "pair"},
    {ShowMode::kQuilt, "quilt"},
}};

bool isPossible(ShowMode mode, const ShowAbilities& abilities) {
  if (mode == ShowMode::kNative) return abilities.can_native;
  return mode != ShowMode::kWeave || abilities.can_weave;
}

ShowEffect nextMode(const ShowAbilities& abilities, ShowSettings& settings) {
  const ShowMode before = settings.mode;
  do {
    settings.mode = kModes[(static_cast<size_t>(settings.mode) + 1) % kModes.size()].first;
  } while (!isPossible(settings.mode, abilities));
  const bool is_other_display =
      (before == ShowMode::kNative) != (settings.mode == ShowMode::kNative);
  return is_other_display ? ShowEffect::kNewDisplay : ShowEffect::kRedraw;
}

ShowEffect stepView(int by, const v1::AtlasLayout& layout, ShowSettings& settings) {
  if (layout.view_count() == 0) return ShowEffect::kNone;
  const int64_t last = int64_t{layout.view_count()} - 1;
  const int64_t view = int64_t{firstView(settings, layout)} + by;
  settings.view = static_cast<uint32_t>(std::clamp<int64_t>(view, 0, last));
  return ShowEffect::kRedraw;
}

// Only what the atlas has can be changed: 0 says that its display has no such thing.
ShowEffect scale(double by, double of_layout, double min, double max, double& setting) {
  if (of_layout <= 0) return ShowEffect::kNone;
  setting = std::clamp((setting > 0 ? setting : of_layout) * by, min, max);
  return ShowEffect::kNewDisplay;
}

ShowEffect toggle(bool& setting) {
  setting = !setting;
  return ShowEffect::kRedraw;
}

uint32_t pairDistance(const ShowSettings& settings, const v1::AtlasLayout& layout) {
  if (settings.pair_distance > 0) return settings.pair_distance;
  return std::max(layout.view_count() / 8, 1u);
}

// Copies settings changed by keys into a quilt or a panel.
template <typename Kind>
void turn(const ShowSettings& settings, Kind& kind) {
  if (settings.focal_distance_m > 0) kind.set_focal_distance_m(settings.focal_distance_m);
  if (settings.view_cone_rad > 0) kind.set_view_cone_rad(settings.view_cone_rad);
}

}  // namespace

std::string_view nameOf(ShowMode mode) {
  return kModes[static_cast<size_t>(mode)].second;
}

std::optional<ShowMode> modeNamed(std::string_view name) {
  for (const auto& [mode, its_name] : kModes) {
    if (its_name == name) return mode;
  }
  return std::nullopt;
}

std::optional<ShowAction> actionOfKey(int32_t sdl_key) {
  switch (sdl_key) {
    case SDLK_ESCAPE:
    case SDLK_q:
      return ShowAction::kQuit;
    case SDLK_m:
      return ShowAction::kNextMode;
    case SDLK_LEFT:
      return ShowAction::kPreviousView;
    case SDLK_RIGHT:
      return ShowAction::kNextView;
    case SDLK_UP:
      return ShowAction::kFocusFurther;
    case SDLK_DOWN:
      return ShowAction::kFocusNearer;
    case SDLK_LEFTBRACKET:
      return ShowAction::kNarrowerCone;
    case SDLK_RIGHTBRACKET:
      return ShowAction::kWiderCone;
    case SDLK_b:
      return ShowAction::kToggleBlend;
    case SDLK_i:
      return ShowAction::kToggleStatistics;
    case SDLK_f:
      return ShowAction::kToggleFullScreen;
    default:
      return std::nullopt;
  }
}

ShowEffect applyAction(ShowAction action, const v1::AtlasLayout& layout,
                       const ShowAbilities& abilities, ShowSettings& settings) {
  const auto focus = [&](double by) {
    return scale(by, layout.focal_distance_m(), kFocusMin_m, kFocusMax_m,
                 settings.focal_distance_m);
  };
  const auto cone = [&](double by) {
    return scale(by, layout.view_cone_rad(), kConeMin_rad, kConeMax_rad, settings.view_cone_rad);
  };
  switch (action) {
    case ShowAction::kQuit:
      return ShowEffect::kQuit;
    case ShowAction::kNextMode:
      return nextMode(abilities, settings);
    case ShowAction::kPreviousView:
      return stepView(-1, layout, settings);
    case ShowAction::kNextView:
      return stepView(1, layout, settings);
    case ShowAction::kFocusFurther:
      return focus(kStep);
    case ShowAction::kFocusNearer:
      return focus(1 / kStep);
    case ShowAction::kNarrowerCone:
      return cone(1 / kStep);
    case ShowAction::kWiderCone:
      return cone(kStep);
    case ShowAction::kToggleBlend:
      return toggle(settings.is_blended);
    case ShowAction::kToggleStatistics:
      return toggle(settings.has_statistics);
    case ShowAction::kToggleFullScreen:
      return ShowEffect::kFullScreen;
  }
  return ShowEffect::kNone;
}

uint32_t firstView(const ShowSettings& settings, const v1::AtlasLayout& layout) {
  const uint32_t last = std::max(layout.view_count(), 1u) - 1;
  if (settings.view) return std::min(*settings.view, last);
  if (settings.mode != ShowMode::kPair) return layout.view_count() / 2;
  return (last - std::min(pairDistance(settings, layout), last)) / 2;
}

uint32_t secondView(const ShowSettings& settings, const v1::AtlasLayout& layout) {
  const uint32_t last = std::max(layout.view_count(), 1u) - 1;
  return std::min(firstView(settings, layout) + pairDistance(settings, layout), last);
}

v1::Display displayFor(const ShowSettings& settings, const v1::Display& asked,
                       const std::optional<Calibration>& calibration) {
  v1::Display display = asked;
  if (settings.mode == ShowMode::kNative && calibration) {
    v1::LenticularDisplay& panel = *display.mutable_lenticular();
    panel.set_calibration_json(writeCalibration(*calibration));
    panel.set_view_cone_rad(asked.quilt().view_cone_rad());
    panel.set_focal_distance_m(asked.quilt().focal_distance_m());
    panel.set_fov_y_rad(asked.quilt().fov_y_rad());
    turn(settings, panel);
  } else if (display.has_quilt()) {
    turn(settings, *display.mutable_quilt());
  } else if (display.has_stereo() && settings.focal_distance_m > 0) {
    display.mutable_stereo()->set_focal_distance_m(settings.focal_distance_m);
  }
  return display;
}

}  // namespace viewloom::show
