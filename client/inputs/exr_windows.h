// SPDX-License-Identifier: Apache-2.0
// Which px of EXR files a frame takes: the picture and what was rendered around it.
#pragma once

#include <string>

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

}  // namespace viewloom::inputs
