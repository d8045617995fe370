// SPDX-License-Identifier: Apache-2.0
#include "pipeline/tracked_frame.h"

#include <algorithm>

#include "retime/frame_retimer.h"

namespace viewloom {
namespace {

bool hasMotion(const std::vector<LayerPlanes>& layers) {
  return std::any_of(layers.begin(), layers.end(),
                     [](const LayerPlanes& layer) { return layer.motion != nullptr; });
}

// Where sources that are not the first say themselves how their surfaces move, their cameras don't.
std::vector<TrackedSource> otherSources(const Frame& frame, const Frame* before) {
  std::vector<TrackedSource> others;
  for (size_t i = 1; i < frame.sources.size(); ++i) {
    TrackedSource& other = others.emplace_back();
    other.pose = frame.format.sources[i].camera.pose;
    if (hasMotion(frame.sources[i])) {
      other.content = ContentMotion::kStands;
    } else if (before != nullptr && i < before->sources.size()) {
      other.content = contentMotion(*before, frame, i);
    }
  }
  return others;
}

}  // namespace

TrackedFrame trackedFrame(const Frame& frame, const Frame* before, double inv_z_near) {
  const int64_t captured_ns = frame.format.capture_time_ns;
  return {.pose = frame.format.sources.front().camera.pose,
          .captured_ns = captured_ns,
          .arrived_ns = captured_ns,
          .built_ns = captured_ns,
          .inv_z_near = inv_z_near,
          .things_move = movesByItself(frame),
          .others = otherSources(frame, before)};
}

}  // namespace viewloom
