// SPDX-License-Identifier: Apache-2.0
// Integral imaging: microlenses in front of a panel, behind each the elemental image that it shows
// to all directions at once (Lippmann 1908; near the eye: Lanman and Luebke, "Near-Eye Light Field
// Displays", 2013).
#pragma once

#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "display/kind.h"

namespace viewloom {

// Microlenses in front of a panel, with a picture behind each (proto IntegralDisplay).
struct IntegralSpec {
  static constexpr const char* kName = "integral";

  std::string preset;
  SizePx panel_px;
  double pixel_pitch_m = 0;
  double lens_pitch_m = 0;
  double focal_length_m = 0;
  uint32_t lens_columns = 0;  // 0 = as many as fit on the panel
  uint32_t lens_rows = 0;
  glm::dvec2 offset_px{0.0};  // from the panel's middle to the lenses', right and down
  bool is_flipped = false;    // each picture is turned by 180 degrees
  double scale = 0;           // metres of the scene for each metre of the panel; 0 = 1
  double distance_m = 0;      // from the display's eye to the lenses, metres of the scene
};

// Pixels that a lens covers. With fewer, a lens shows one picture to everybody. No lens has more.
inline constexpr double kLensPxMin = 1;
inline constexpr double kLensPxMax = 4096;
// Lengths of a panel, from a lens of two pixels of a phone to a wall of hogels.
inline constexpr Range kPanelLength{1e-7, 10};

template <SpecOf<IntegralSpec> Integral, typename Visitor>
void visitFields(Integral& integral, Visitor& visit) {
  visit.label("preset", integral.preset);
  visit("panel_size", integral.panel_px, Range{1, kQuiltSidePxMax});
  visit("pixel_pitch_m", integral.pixel_pitch_m, kPanelLength);
  visit("lens_pitch_m", integral.lens_pitch_m, kPanelLength);
  visit("focal_length_m", integral.focal_length_m, kPanelLength);
  visit("lens_columns", integral.lens_columns, Range{1, kQuiltSidePxMax, true});
  visit("lens_rows", integral.lens_rows, Range{1, kQuiltSidePxMax, true});
  visit("offset_x_px", integral.offset_px.x, Range{-kLensPxMax, kLensPxMax});
  visit("offset_y_px", integral.offset_px.y, Range{-kLensPxMax, kLensPxMax});
  visit("flipped", integral.is_flipped);
  visit("scale", integral.scale, Range{1e-6, 1e6, true});
  visit("distance_m", integral.distance_m, kOptionalDistance);
}

absl::Status takePreset(IntegralSpec& integral);
absl::Status settle(IntegralSpec& integral);
TileGrid tileGrid(const IntegralSpec& integral);
void describe(const IntegralSpec& integral, const StreamDefaults& defaults, AtlasLayout& layout);
double* focalPlane(IntegralSpec& integral);
std::optional<OpenFov> openFov(const IntegralSpec& integral);
// Known devices. None is verified on hardware.
std::vector<KnownDevice> devicesOf(const IntegralSpec& any);

}  // namespace viewloom
