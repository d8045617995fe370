// SPDX-License-Identifier: Apache-2.0
// Answers for rays through a lens that met no sheet. They follow the rules of walked rays
// (shaders/color.md, Colour of hidden and outside rays).
#pragma once

#include <cstdint>

#include "lens/gather_kernels.h"

namespace viewloom {

inline constexpr int32_t kNothingSeen = -1;

// The texel, in the color of all layers, that an open ray of these is taken to see: the far side of
// a silhouette that it passed behind; or what it passed into, if that was no silhouette but a
// surface that no sheet stands for. kNothingSeen: it passed behind nothing that it could be told
// by.
int32_t guessSeen(const GatheredRays& rays, const OpenRay& open);

}  // namespace viewloom
