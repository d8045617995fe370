// SPDX-License-Identifier: Apache-2.0
// Interpretation of input files from their headers and the user's words, before any pixel is read.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/status.h"
#include "inputs/input_settings.h"

namespace viewloom::inputs {

// Range that is settled once the depth is there.
enum class DepthRange {
  kStated,      // nothing: the format is complete
  kBetween,     // nothing: it is complete by the near and far of the settings
  kNormalised,  // the format follows from the range of the samples (normalisedFormat)
  k2dPlusZ,     // ... by twoDPlusZFormat
};

// Where the display window of an EXR file lies in planes that are larger: what the camera was set
// up for.
struct DisplayFrame {
  double left_px = 0;
  double top_px = 0;
  double width_px = 0;
  double height_px = 0;
};

struct Interpretation {
  InputKind kind = InputKind::kPlain;     // never kAuto
  v1::SourceFiles source;                 // one layer; the camera as far as files state it
  std::optional<v1::SizePx> camera_size;  // px that the camera's intrinsics count; none = depth's
  double pixel_aspect = 1;                // width of a px divided by its height
  std::optional<DisplayFrame> display;    // of the depth plane; none = all of it
  Projection projection = Projection::kFlat;
  DepthRange range = DepthRange::kStated;
  uint32_t video_frame_count = 1;  // of .yuv files
  // Channel of depth that Nuke wrote: its samples tell whether they are Z or 1/Z. Empty = known.
  std::string nuke_channel;
  std::vector<std::string> notes;  // what a user may want to know, a sentence each
};

// INVALID_ARGUMENT with the option or the file at fault and what is accepted.
absl::StatusOr<Interpretation> interpret(const InputSettings& settings, const InputFiles& files);

}  // namespace viewloom::inputs
