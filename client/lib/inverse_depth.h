// SPDX-License-Identifier: Apache-2.0
// Planes of binary32 depth as 1/Z, whatever they measure.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/byte_pool.h"
#include "frame/camera.h"
#include "viewloom/v1/frame.pb.h"

namespace viewloom {

inline constexpr float kNoInvZ = -1;  // no surface

// What a source's depth planes are seen with, in px of one of them; of a cube map, by each face.
// Nothing when the source does not say it.
std::optional<Intrinsics> depthIntrinsics(const v1::Source& source);

// float[height][width], 1/m: 0 is the sky, kNoInvZ no surface. Nothing when the declaration is one
// that a server refuses, or the bytes are not what it says.
std::optional<std::vector<float>> inverseDepth(const v1::Plane& plane,
                                               std::span<const uint8_t> bytes,
                                               const Intrinsics& intrinsics, bool is_cube_map);

}  // namespace viewloom
