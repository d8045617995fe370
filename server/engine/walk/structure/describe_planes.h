// SPDX-License-Identifier: Apache-2.0
// Plane formats as the build kernels take them.
#pragma once

#include "frame/frame.h"
#include "shared/structure_abi.h"

namespace viewloom {

// `offset_bytes`: of the plane in the upload, a multiple of its sample's size.
abi::DepthPlane describeDepth(const PlaneFormat& depth, uint64_t offset_bytes);
// All but the addresses and what it becomes.
abi::ConvertColorPush describeConversion(const PlaneFormat& color, PlaneEncoding decoded_encoding,
                                         double exposure_ev, ToneMap tone_map);

}  // namespace viewloom
