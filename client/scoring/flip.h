// SPDX-License-Identifier: Apache-2.0
// FLIP: how much two pictures seem to differ to a person who flips between them.
// Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astrom, Fairchild: "FLIP: A Difference Evaluator
// for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020; for pictures of
// 0..1 (LDR-FLIP), with the constants of the paper.
#pragma once

#include <span>
#include <vector>

#include "frame/size.h"

namespace viewloom {

// The paper's viewer: 0.7 m before a screen 0.7 m wide with 3840 px.
inline constexpr double kFlipPxPerDegree = 67.020643276;  // 3840 pi / 180

// float[height][width]: 0 = no visible difference, 1 = the largest there is.
// got, truth: float[height][width][3], R G B of BT.709, linear light; held within 0..1.
std::vector<float> flipMap(std::span<const float> got, std::span<const float> truth, SizePx size_px,
                           double px_per_degree = kFlipPxPerDegree);

}  // namespace viewloom
