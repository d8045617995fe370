// SPDX-License-Identifier: Apache-2.0
// Plane formats as the build kernels take them.
#pragma once

#include "frame/frame.h"
#include "shared/structure_abi.h"

namespace viewloom {

// All but the address of the samples.
abi::DepthPlane describeDepth(const PlaneFormat& depth);
// All but the addresses.
abi::ConvertColorPush describeConversion(const PlaneFormat& color, PlaneEncoding decoded_encoding,
                                         double exposure_ev);

}  // namespace viewloom
