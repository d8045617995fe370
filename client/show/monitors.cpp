// SPDX-License-Identifier: Apache-2.0
#include "show/monitors.h"

#include <SDL.h>

#include "base/str_cat.h"

namespace viewloom::show {
namespace {

std::string describeSize(SizePx size_px) {
  return strCat(size_px.width, "x", size_px.height);
}

}  // namespace

std::vector<Monitor> listMonitors() {
  std::vector<Monitor> monitors;
  for (int number = 0; number < SDL_GetNumVideoDisplays(); ++number) {
    SDL_DisplayMode mode;
    if (SDL_GetDesktopDisplayMode(number, &mode) != 0) continue;
    const char* name = SDL_GetDisplayName(number);
    monitors.push_back({.number = number,
                        .name = name == nullptr ? "unnamed" : name,
                        .size_px = {static_cast<uint32_t>(mode.w), static_cast<uint32_t>(mode.h)}});
  }
  return monitors;
}

std::string describeMonitors(std::span<const Monitor> monitors) {
  std::string text;
  for (const Monitor& monitor : monitors) {
    text += strCat(text.empty() ? "" : ", ", monitor.number, ": ", monitor.name, " (",
                   describeSize(monitor.size_px), ")");
  }
  return text.empty() ? "none" : text;
}

absl::StatusOr<Monitor> chooseMonitor(std::span<const Monitor> monitors,
                                      const MonitorChoice& choice) {
  for (const Monitor& monitor : monitors) {
    if (choice.number
            ? monitor.number == *choice.number
            : choice.is_windowed || !choice.panel_px || monitor.size_px == *choice.panel_px) {
      return monitor;
    }
  }
  if (!choice.number && choice.panel_px) {
    return absl::InvalidArgumentError(
        strCat("no monitor has the ", describeSize(*choice.panel_px),
               " px of the calibrated panel; there are ", describeMonitors(monitors),
               ". Switch the panel on at its own resolution, or show a window with --windowed"));
  }
  return absl::InvalidArgumentError(strCat("--monitor ", choice.number.value_or(0),
                                           ": there is no such monitor; there are ",
                                           describeMonitors(monitors)));
}

absl::Status checkNativePixels(SizePx window_px, SizePx panel_px) {
  if (window_px == panel_px) return absl::OkStatus();
  return absl::InvalidArgumentError(strCat(
      "the window has ", describeSize(window_px), " px and the calibrated panel ",
      describeSize(panel_px),
      ": they must be equal. Set the panel to its own resolution and a scale of 100 %, or choose "
      "another monitor with --monitor"));
}

}  // namespace viewloom::show
