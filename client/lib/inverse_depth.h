// SPDX-License-Identifier: Apache-2.0
// Converts planes of depth to 1/Z as binary32, whatever they measure.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/byte_pool.h"
#include "frame/camera.h"
#include "viewloom/v1/frame.pb.h"

namespace viewloom {

inline constexpr float kNoInvZ = -1;  // no surface

// Intrinsics of a source in pixels of its depth planes; for a cube map, those of each face. Empty
// if the source has no projection.
std::optional<Intrinsics> depthIntrinsics(const v1::Source& source);

// Returns float[height][width], 1/m. 0 is the sky, kNoInvZ is no surface. Empty if a server would
// refuse the plane, or if the bytes do not match it.
std::optional<std::vector<float>> inverseDepth(const v1::Plane& plane,
                                               std::span<const uint8_t> bytes,
                                               const Intrinsics& intrinsics, bool is_cube_map);

}  // namespace viewloom
