// SPDX-License-Identifier: Apache-2.0
// Frames of the synthetic scene, and displays, as they go over the wire.
#pragma once

#include <cstdint>

#include "frame/size.h"
#include "lib/wire_frame.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom::test {

// RGBA8 colour and binary32 planar depth in each layer.
WireFrame syntheticWireFrame(SizePx size_px, uint32_t layer_count, double time_s);

// Half-closed with it, a call gets every atlas of a quilt of 4x2 views.
v1::OpenDisplay openQuilt(const std::string& stream, SizePx size_px);

}  // namespace viewloom::test
