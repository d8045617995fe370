// SPDX-License-Identifier: Apache-2.0
// Samples of a deep pixel, and points in front of each other that show the same.
#pragma once

#include <glm/vec3.hpp>

namespace viewloom::deep {

// Sample as in the file: matter between two depths, or at one.
struct DeepSample {
  float z_m = 0;
  float z_back_m = 0;  // a point sample has no more than z_m
  float alpha = 0;
  glm::vec3 color{0};  // linear light, premultiplied
};

// A surface that covers a share of the pixel.
struct DeepPoint {
  double inv_z = 0;  // 1/m
  double alpha = 0;
  glm::dvec3 color{0};  // linear light, premultiplied
};

}  // namespace viewloom::deep
