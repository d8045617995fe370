// SPDX-License-Identifier: Apache-2.0
// How a display is shown, and what keys change about it.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "calibration/calibration.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom::show {

enum class ShowMode {
  kNative,  // the server interlaces for the panel
  kWeave,   // a quilt, woven here
  kView,    // one view
  kPair,    // two views side by side, left eye left
  kQuilt,   // the atlas as it comes
};

std::string_view nameOf(ShowMode mode);
std::optional<ShowMode> modeNamed(std::string_view name);

struct ShowSettings {
  ShowMode mode = ShowMode::kView;
  std::optional<uint32_t> view;  // of kView, and the left one of kPair; none: around the middle
  uint32_t pair_distance = 0;    // views between the two of a pair; 0: an eighth of all
  bool is_blended = true;        // neighbouring views, where they are woven here
  bool has_statistics = false;   // on the screen
  double focal_distance_m = 0;   // 0: as the display was asked for
  double view_cone_rad = 0;      // 0: as the display was asked for
};

enum class ShowAction {
  kQuit,
  kNextMode,
  kPreviousView,
  kNextView,
  kFocusFurther,
  kFocusNearer,
  kNarrowerCone,
  kWiderCone,
  kToggleBlend,
  kToggleStatistics,
  kToggleFullScreen,
};

// The action of a key of SDL's, if it has one.
std::optional<ShowAction> actionOfKey(int32_t sdl_key);

enum class ShowEffect { kNone, kRedraw, kNewDisplay, kFullScreen, kQuit };

// Modes that can be used here.
struct ShowAbilities {
  bool can_weave = false;   // a calibrated panel has the window's px
  bool can_native = false;  // and the server has not refused to interlace
};

// Changes the settings as the key says. layout: of the atlas on the screen.
ShowEffect applyAction(ShowAction action, const v1::AtlasLayout& layout,
                       const ShowAbilities& abilities, ShowSettings& settings);

// The first view to show and, of a pair, the second.
uint32_t firstView(const ShowSettings& settings, const v1::AtlasLayout& layout);
uint32_t secondView(const ShowSettings& settings, const v1::AtlasLayout& layout);

// Request to the server. asked: the user's display, for modes other than kNative.
v1::Display displayFor(const ShowSettings& settings, const v1::Display& asked,
                       const std::optional<Calibration>& calibration);

}  // namespace viewloom::show
