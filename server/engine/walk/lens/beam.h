// SPDX-License-Identifier: Apache-2.0
// All rays of a block of px through a lens: where they are in the image of the source, by 1/Z.
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "shared/trace_abi.h"

namespace viewloom {

// A rectangle of the source's image, px.
struct RectPx {
  glm::vec2 low{0};
  glm::vec2 high{0};
};

// The place of a ray in the image is linear in 1/Z. Rays through the middle of the lens are
// enclosed by those of the block's corners; the lens is taken to be as wide for all of them as it
// is for that in the middle.
class Beam {
 public:
  // Beam of the pixels [low, high) of a tile, whose rays all go where the source looks; from 1/Z =
  // 0 to this one, 1/m, > 0.
  Beam(const abi::ViewParams& view, glm::vec2 low_px, glm::vec2 high_px, float inv_z_near);

  // Encloses where rays are while 1/Z is between these.
  RectPx rectOver(float least_inv_z, float largest_inv_z) const;

 private:
  // Where 1/Z is 0, and what that moves by for each 1/m.
  RectPx far_;
  RectPx pace_;
  // How far rays through the rim are beside, for both axes of the lens: x, y, x, y.
  glm::vec4 rim_far_{0};
  glm::vec4 rim_pace_{0};
};

// Places along both axes at both ends lie side by side: the compiler makes vectors of them.
inline RectPx Beam::rectOver(float least_inv_z, float largest_inv_z) const {
  const float inv_z[4] = {least_inv_z, least_inv_z, largest_inv_z, largest_inv_z};
  float low[4];
  float high[4];
  for (int i = 0; i < 4; ++i) {
    const int axis = i % 2;
    const float of_x = rim_far_[axis] + inv_z[i] * rim_pace_[axis];
    const float of_y = rim_far_[axis + 2] + inv_z[i] * rim_pace_[axis + 2];
    // One of them is 0 for a lens that is not turned against the source.
    const float beside = std::abs(of_x) + std::abs(of_y);
    low[i] = far_.low[axis] + inv_z[i] * pace_.low[axis] - beside;
    high[i] = far_.high[axis] + inv_z[i] * pace_.high[axis] + beside;
  }
  return {{std::min(low[0], low[2]), std::min(low[1], low[3])},
          {std::max(high[0], high[2]), std::max(high[1], high[3])}};
}

}  // namespace viewloom
