// SPDX-License-Identifier: Apache-2.0
// Shared end of all patterns: their scale, their camera, and the end of drawing.
#pragma once

#include <initializer_list>

#include "patterns/layer_drawing.h"
#include "patterns/pattern.h"
#include "text/font.h"

namespace viewloom::patterns {

// Patterns are laid out for 1920 x 1080: px of the source for one of those.
double unitPx(SizePx size_px);
PxBox wholeImage(SizePx size_px);
// Focal length of patterns that need no other.
double defaultFocalPx(SizePx size_px);

// Fails where letters could not be written.
absl::StatusOr<Pattern> finishPattern(SizePx size_px, double focal_px,
                                      std::initializer_list<LayerDrawing*> layers,
                                      const Lettering& lettering);

}  // namespace viewloom::patterns
