// SPDX-License-Identifier: Apache-2.0
// Facts of an EXR header that count for every kind of file: which px a frame takes, px that are not
// square, the camera, the primaries, environment maps.
#pragma once

#include <string>

#include "base/status.h"
#include "files/exr_description.h"
#include "files/exr_header.h"
#include "inputs/interpretation.h"

namespace viewloom::inputs {

struct ExrFrameWindows {
  files::ExrWindow display;
  files::ExrWindow data;  // where all channels of the frame have px
};

// The window that holds the display window and all data: overscan is used, and the picture keeps
// its place where data is missing. Sets `window` and the result's display frame where that is not
// the display window, and notes it. What is beyond the limits of planes is left out, with a note.
void settleWindow(const ExrFrameWindows& windows, v1::ExrWindow& window, Interpretation& result);

files::ExrWindow intersection(const files::ExrWindow& a, const files::ExrWindow& b);
bool isSame(const files::ExrWindow& a, const files::ExrWindow& b);

// Sets the aspect of px and the projection of `result`, and notes them and the primaries.
void readHeaderFacts(const InputSettings& settings, const files::ExrDescription& description,
                     Interpretation& result);

// Sets the camera that worldToCamera or Unreal's attributes state; `file` is for messages.
absl::Status readHeaderCamera(const InputSettings& settings, const std::string& file,
                              const files::ExrDescription& description, Interpretation& result);

// Reads all that is to be known of a deep file from its header: its window and its camera. Fills in
// `deep`.
absl::StatusOr<Interpretation> interpretDeep(const InputSettings& settings, v1::DeepFile& deep);

}  // namespace viewloom::inputs
