// SPDX-License-Identifier: Apache-2.0
// A lenticular device's own calibration, and the file it keeps it in (visual.json).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "frame/size.h"

namespace viewloom {

// A position in px, from the centre of a px: to the right, upwards.
struct SubpixelOffset {
  double x_px = 0;
  double y_px = 0;

  bool operator==(const SubpixelOffset&) const = default;
};

// Where the subpixels of a px lie, on panels whose subpixels are no three equal stripes.
struct SubpixelCell {
  SubpixelOffset red;
  SubpixelOffset green;
  SubpixelOffset blue;

  bool operator==(const SubpixelCell&) const = default;
};

// As the file has it: makeLenticular() turns it into lenses over px.
struct Calibration {
  double pitch = 0;             // lenses per inch, across them; not 0
  double slope = 0;             // of the lenses: rows up per column to the left; 0.01..1e6 in size
  double center = 0;            // lenses that the pattern is moved to the right
  double view_cone_deg = 40;    // (0, 180)
  double vertical_angle = 0;    // kept; no known formula has it
  double dpi = 0;               // of the panel's px
  SizePx screen_px;             // 1..16384 a side
  bool inv_view = true;         // views run from the right end of a lens to the left
  bool flip_x = false;          // the panel is mounted mirrored: turns tilt and subpixels around
  bool flip_y = false;          // kept; no known formula has it
  bool flip_subpixels = false;  // red and blue change places
  uint32_t cell_pattern_mode = 0;   // 0..4: kCells... of shaders/shared/lenticular.h
  std::vector<SubpixelCell> cells;  // none: three equal stripes; else up to four
  std::string serial;               // "LKG-..."; may be empty, up to 100 bytes
  std::string config_version;       // "3.0"; may be empty, up to 100 bytes

  bool operator==(const Calibration&) const = default;
};

// Longer texts are refused before they are looked at; real files have about 1 KiB.
inline constexpr size_t kCalibrationBytesMax = 64 << 10;

// Every spelling that devices and tools write: numbers plain or as {"value": x}, CellPatternMode or
// cellPatternMode, files of old devices that lack what came later, and the text of the file as a
// JSON string, which is how Bridge hands it on. Unknown keys (fringe) are ignored.
// INVALID_ARGUMENT names the key.
absl::StatusOr<Calibration> parseCalibration(std::string_view json);

// The file, in the wrapped spelling, ending in a line feed. What parseCalibration() returned comes
// back exactly.
std::string writeCalibration(const Calibration& calibration);

}  // namespace viewloom
