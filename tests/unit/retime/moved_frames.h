// SPDX-License-Identifier: Apache-2.0
// Small frames in which surfaces move, px by px, and what became of them.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "frame/frame.h"

namespace viewloom::test {

inline constexpr SizePx kMovedPx{32, 24};
inline constexpr double kMovedFocal_px = 32;

// A sample of a layer.
struct MovingPx {
  float inv_z = -1;  // 1/m; below 0: no surface
  glm::u8vec3 color{0};
  glm::vec3 motion_mps{0.0F};  // world
};
using MovingLayer = std::function<MovingPx(uint32_t x, uint32_t y)>;

Camera movedCamera();

// Frame 1, of one source: DISPARITY in binary32. 1/m: the connection tolerance.
FramePtr movingFrame(const std::vector<MovingLayer>& layers, double connection_tolerance,
                     const Pose& pose = {}, SizePx size_px = kMovedPx);

// Inverse depth and colour of the first source.
float invZAt(const Frame& frame, uint32_t layer, uint32_t x, uint32_t y);
glm::u8vec3 colorAt(const Frame& frame, uint32_t layer, uint32_t x, uint32_t y);

// Different in every px.
glm::u8vec3 colorOfPx(uint32_t x, uint32_t y, uint8_t blue);

}  // namespace viewloom::test
