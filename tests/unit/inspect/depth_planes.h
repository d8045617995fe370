// SPDX-License-Identifier: Apache-2.0
// Depth planes made of formulas, to measure and to suspect.
#pragma once

#include <cstring>
#include <functional>
#include <vector>

#include "viewloom/v1/frame.pb.h"

namespace viewloom::test {

struct DepthPlane {
  v1::Plane plane;
  std::vector<uint8_t> bytes;
};

template <typename Sample>
DepthPlane depthPlane(uint32_t width_px, uint32_t height_px, v1::DepthMeaning meaning,
                      const std::function<Sample(uint32_t x, uint32_t y)>& sample) {
  DepthPlane made;
  made.plane.set_kind(v1::PLANE_KIND_DEPTH);
  made.plane.set_encoding(sizeof(Sample) == 2 ? v1::PLANE_ENCODING_DEPTH_U16
                                              : v1::PLANE_ENCODING_DEPTH_F32);
  made.plane.mutable_size()->set_width(width_px);
  made.plane.mutable_size()->set_height(height_px);
  made.plane.mutable_depth()->set_meaning(meaning);
  made.bytes.resize(sizeof(Sample) * width_px * height_px);
  for (uint32_t y = 0; y < height_px; ++y) {
    for (uint32_t x = 0; x < width_px; ++x) {
      const Sample value = sample(x, y);
      std::memcpy(&made.bytes[sizeof(Sample) * (size_t{y} * width_px + x)], &value, sizeof(Sample));
    }
  }
  return made;
}

}  // namespace viewloom::test
