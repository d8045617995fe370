// SPDX-License-Identifier: Apache-2.0
// Calibration of a lenticular device, and its file (visual.json).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "frame/size.h"

namespace viewloom {

// A position in px from the centre of a pixel: right, up.
struct SubpixelOffset {
  double x_px = 0;
  double y_px = 0;

  bool operator==(const SubpixelOffset&) const = default;
};

// Places of the subpixels of a pixel, on panels without three equal stripes.
struct SubpixelCell {
  SubpixelOffset red;
  SubpixelOffset green;
  SubpixelOffset blue;

  bool operator==(const SubpixelCell&) const = default;
};

// Values of the file. makeLenticular() turns them into lenses over pixels.
struct Calibration {
  double pitch = 0;                // lenses per inch, across them; not 0
  double slope = 0;                // rows up for each column to the left; 0.01..1e6 in size
  double center = 0;               // shift of the pattern to the right, in lenses
  double view_cone_deg = 40;       // (0, 180)
  double vertical_angle = 0;       // kept; no known formula uses it
  double dpi = 0;                  // pixels of the panel per inch
  SizePx screen_px;                // 1..16384 a side
  bool inv_view = true;            // views run from the right end of a lens to the left
  bool flip_x = false;             // the panel is mounted mirrored: tilt and subpixels are reversed
  bool flip_y = false;             // kept; no known formula uses it
  bool flip_subpixels = false;     // red and blue change places
  uint32_t cell_pattern_mode = 0;  // 0..4: kCells... of shaders/shared/lenticular.h
  std::vector<SubpixelCell> cells;  // none: three equal stripes; else up to four
  std::string serial;               // "LKG-..."; may be empty, up to 100 bytes
  std::string config_version;       // "3.0"; may be empty, up to 100 bytes

  bool operator==(const Calibration&) const = default;
};

// Largest file that is read. Real files have about 1 KiB.
inline constexpr size_t kCalibrationBytesMax = 64 << 10;

// Reads a calibration in every spelling of devices and tools. Numbers are plain or {"value": x}.
// The key is CellPatternMode or cellPatternMode. Files of old devices lack newer keys. Bridge gives
// the text of the file as a JSON string. Unknown keys (fringe) are ignored. INVALID_ARGUMENT names
// the key.
absl::StatusOr<Calibration> parseCalibration(std::string_view json);

// Writes the file, with numbers as {"value": x}, ending in a line feed. parseCalibration() reads it
// back exactly.
std::string writeCalibration(const Calibration& calibration);

}  // namespace viewloom
