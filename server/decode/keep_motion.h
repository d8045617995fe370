// SPDX-License-Identifier: Apache-2.0
// A layer's plane of motion, as far as anything moves.
#pragma once

#include "base/byte_pool.h"
#include "frame/frame.h"

namespace viewloom {

// Fills in `motion` and `bad_motions_count` from a decoded plane, binary16[h][w][3]. Vectors that
// are not finite count as bad, and become 0; a plane in which nothing moves is not kept.
void keepMotion(SharedBytes plane, BytePool& pool, LayerPlanes& to);

}  // namespace viewloom
