// SPDX-License-Identifier: Apache-2.0
// Atlases whose views lie in a stack of pictures: color as H.264, and the planes beside it.
#pragma once

#include "base/status.h"
#include "lib/atlas.h"

namespace viewloom {

class VideoDecoder;

// Whether the stack of a layout adds up: every view has a cell, and cells hold the views. DATA_LOSS
// otherwise. Expects a layout with a stack and of a checked size.
absl::Status checkStack(const v1::AtlasLayout& layout);

// Whether the atlas has a whole plane COLOR of H.264, and a layout with a stack.
bool isWholeVideo(const Atlas& atlas);

// Decodes the pictures, and arranges their views as the layout says. Expects isWholeVideo().
// DATA_LOSS if a picture is damaged, or has another size than the layout says. FAILED_PRECONDITION
// if the atlas refers to another.
absl::StatusOr<AtlasPicture> decodeVideo(const Atlas& atlas);
// The same with the decoder of the atlas before, also of an atlas that refers to that one.
absl::StatusOr<AtlasPicture> decodeVideo(const Atlas& atlas, VideoDecoder& decoder);
// The atlas refers to one that was not decoded.
absl::Status refusedReference(const Atlas& atlas);

// Arranges the views of a plane as the layout says. `stacked`: all pictures, one below the other.
AtlasPicture unstack(const AtlasPicture& stacked, const v1::AtlasLayout& layout);

}  // namespace viewloom
