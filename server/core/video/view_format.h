// SPDX-License-Identifier: Apache-2.0
// Format of videos of views: for decoders of many pixels a second.
#pragma once

#include <cstdint>

#include "video/video_encoder.h"

namespace viewloom {

// Viewers decode all views at once, and browsers do it on a CPU: so the entropy coding is the one
// that decoders read in half of the time, and pictures have slices for their threads to share. The
// stream depends on nothing but the size and the quantisation.
// Expects a size within level 5.1.
VideoFormat viewFormat(SizePx picture_px, uint32_t qp);

}  // namespace viewloom
