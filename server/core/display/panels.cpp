// SPDX-License-Identifier: Apache-2.0
#include "display/panels.h"

#include <algorithm>
#include <array>

namespace viewloom {
namespace {

struct Panel {
  std::string_view preset;
  SizePx screen_px;
  double dpi;
  double pitch;
  double slope;
  double center;
  double view_cone_deg;
  uint32_t cell_pattern_mode = 0;
};

// Published templates; where they name a pattern of cells, they leave out the cells. That of the
// 8.9" and the cells of the 16" are those of single public units.
constexpr auto kPanels = std::to_array<Panel>({
    {"16_gen3_l", {3840, 2160}, 283, 44.72, -6.9, 0.5, 50, 2},
    {"16_gen3_p", {2160, 3840}, 283, 44.72, -7.45, 0, 50, 4},
    {"32_gen3_l", {7680, 4320}, 280, 75, -7.2, -0.2, 50},
    {"32_gen3_p", {4320, 7680}, 280, 80.7, -6.3, -0.3, 54, 2},
    {"65", {7680, 4320}, 136, 42, -6, 0.3, 40},
    {"8_9_gen1", {2560, 1600}, 338, 49.818, 5.0443, 0.1769, 40},
    {"go_p", {1440, 2560}, 491, 80.7, -6.3, -0.3, 54},
    {"portrait", {1536, 2048}, 324, 52, -7, 0.5, 40},
});

std::vector<SubpixelCell> cellsOf(const Panel& panel) {
  if (panel.preset != "16_gen3_l") return {};
  return {{.red = {-0.31, 0.25}, .green = {0.28, 0.25}, .blue = {0, -0.25}},
          {.red = {-0.31, -0.25}, .green = {0.28, -0.25}, .blue = {0, 0.25}}};
}

}  // namespace

std::optional<Calibration> panelOfPreset(std::string_view preset) {
  const auto panel = std::find_if(kPanels.begin(), kPanels.end(),
                                  [&](const Panel& known) { return known.preset == preset; });
  if (panel == kPanels.end()) return std::nullopt;
  return Calibration{.pitch = panel->pitch,
                     .slope = panel->slope,
                     .center = panel->center,
                     .view_cone_deg = panel->view_cone_deg,
                     .dpi = panel->dpi,
                     .screen_px = panel->screen_px,
                     .cell_pattern_mode = panel->cell_pattern_mode,
                     .cells = cellsOf(*panel)};
}

}  // namespace viewloom
