// SPDX-License-Identifier: Apache-2.0
#include "display/presets.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "display/named_display.h"

namespace viewloom {
namespace {

constexpr double kWide = 16.0 / 9.0;
constexpr double kTall = 9.0 / 16.0;

// Looking Glass Factory's published quilt settings (keyconcepts/quilts, device templates).
constexpr auto kPresets = std::to_array<Preset>({
    {"15_6_gen1", "Looking Glass 15.6\" (LKG-4K)", 5, 9, {4096, 4096}, kWide, 40, ""},
    {"16_gen2", "Looking Glass 16\" gen2 (LKG-A)", 5, 9, {4096, 4096}, kWide, 40, ""},
    {"16_gen3_l",
     "Looking Glass 16\" gen3 landscape (LKG-J)",
     7,
     7,
     {5999, 5999},
     kWide,
     50,
     "published as 7x7 at 5999x5999; a real unit reported 8x6 at 7680x4320"},
    {"16_gen3_p", "Looking Glass 16\" gen3 portrait (LKG-H)", 11, 6, {5995, 6000}, kTall, 50, ""},
    {"27_l",
     "Looking Glass 27\" landscape",
     8,
     6,
     {7680, 4320},
     kWide,
     50,
     "one source; the cone is not published and taken from the 16\" gen3"},
    {"27_p",
     "Looking Glass 27\" portrait",
     12,
     4,
     {7680, 4320},
     kTall,
     50,
     "one source; the cone is not published and taken from the 16\" gen3"},
    {"32_gen2", "Looking Glass 32\" gen2 (LKG-B)", 5, 9, {8192, 8192}, kWide, 40, ""},
    {"32_gen3_l", "Looking Glass 32\" gen3 landscape (LKG-L)", 7, 7, {8190, 8190}, kWide, 50, ""},
    {"32_gen3_p", "Looking Glass 32\" gen3 portrait (LKG-K)", 11, 6, {8184, 8184}, kTall, 54, ""},
    {"65",
     "Looking Glass 65\" (LKG-D)",
     8,
     9,
     {8192, 8192},
     kWide,
     40,
     "published at 8192x8192; other software uses 8192x8190, which nine rows divide"},
    {"8_9_gen1", "Looking Glass 8.9\" (LKG-2K)", 5, 9, {4096, 4096}, 1.6, 40, ""},
    {"8k_gen1", "Looking Glass 8K (LKG-8K)", 5, 9, {8192, 8192}, kWide, 40, ""},
    {"go_p", "Looking Glass Go (LKG-E)", 11, 6, {4092, 4092}, kTall, 54, ""},
    {"kiosk",
     "Looking Glass Kiosk (LKG-F)",
     8,
     6,
     {3360, 3360},
     0.75,
     40,
     "sources disagree: 8x6 at 3360x3360, aspect 0.75, or 11x6 at 4092x4092, aspect 0.5625"},
    {"portrait", "Looking Glass Portrait (LKG-P)", 8, 6, {3360, 3360}, 0.75, 40, ""},
});
static_assert(std::ranges::is_sorted(kPresets, {}, &Preset::name));

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

std::span<const Preset> allPresets() {
  return kPresets;
}

const Preset* findPreset(std::string_view name) {
  const auto found = std::ranges::lower_bound(kPresets, name, {}, &Preset::name);
  return found != kPresets.end() && found->name == name ? &*found : nullptr;
}

absl::Status checkPreset(std::string_view name, std::string_view field) {
  if (findPreset(name) != nullptr) return absl::OkStatus();
  std::vector<std::string> names;
  for (const Preset& preset : kPresets) names.emplace_back(preset.name);
  return unknownPreset(name, field, names);
}

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
