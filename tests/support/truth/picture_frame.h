// SPDX-License-Identifier: Apache-2.0
// A true picture as a frame that viewloom can build.
#pragma once

#include <cstdint>
#include <vector>

#include "frame/frame.h"
#include "support/truth/picture.h"

namespace viewloom::truth {

// One source with the first layer_count layers: opaque 8-bit sRGB and binary32 planar depth;
// how surfaces mirror and how they move by themselves, where any does.
FramePtr frameOf(const Picture& picture, uint32_t layer_count);
// A source for each picture.
FramePtr frameOf(const std::vector<Picture>& pictures, uint32_t layer_count);
// One source: a cube map that stands there, of the pictures of its faces in their order.
FramePtr cubeFrameOf(const std::vector<Picture>& faces, const Pose& cube, uint32_t layer_count);

}  // namespace viewloom::truth
