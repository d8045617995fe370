// SPDX-License-Identifier: Apache-2.0
// Moves the samples of a row, with the vectors of the CPU it runs on.
#pragma once

#include <array>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace viewloom {

// Some columns of a row of a layer, as the frame has them.
struct MotionRow {
  uint32_t first = 0;  // columns
  uint32_t end = 0;
  const uint8_t* motion = nullptr;  // binary16[width][3], m/s along the world's axes
  // float[width], 1/m, abi::kNoSurface where nothing is; may be read a vector beyond its width.
  const float* inv_z = nullptr;
  double principal_x_px = 0;
  double down_px = 0;  // from the principal point to the middle of the row
  glm::dvec2 focal_px{0};
  // The camera's axes in the world's, each times the time that has passed, s.
  std::array<glm::dvec3, 3> axes_s{};
};

// float[width], uint8[width] each.
struct MovedRow {
  float* dx_px = nullptr;
  float* dy_px = nullptr;
  float* inv_z = nullptr;
  uint8_t* moves = nullptr;
};

// By how much samples have gone.
struct WayRange {
  glm::dvec2 least_px{0};
  glm::dvec2 most_px{0};
};

// Writes those columns.
WayRange moveRow(const MotionRow& row, const MovedRow& moved);

}  // namespace viewloom
