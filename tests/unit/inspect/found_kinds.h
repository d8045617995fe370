// SPDX-License-Identifier: Apache-2.0
// Suspicions about a depth plane.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "inspect/suspicions.h"
#include "unit/inspect/depth_planes.h"

namespace viewloom::test {

inline std::vector<inspect::Suspicion> suspicionsOf(const DepthPlane& made, uint32_t code_max = 0) {
  v1::Camera camera;
  camera.mutable_intrinsics()->set_focal_x_px(100);
  camera.mutable_intrinsics()->set_focal_y_px(100);
  const auto samples = inspect::readDepthSamples(made.plane, made.bytes, camera);
  EXPECT_TRUE(samples.ok()) << samples.status();
  return inspect::suspectDepth({made.plane, code_max, *samples, inspect::measureDepth(*samples)});
}

inline std::vector<std::string> kindsOf(const DepthPlane& made, uint32_t code_max = 0) {
  std::vector<std::string> kinds;
  for (const inspect::Suspicion& suspicion : suspicionsOf(made, code_max)) {
    kinds.push_back(suspicion.kind);
  }
  return kinds;
}

}  // namespace viewloom::test
