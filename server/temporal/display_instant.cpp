// SPDX-License-Identifier: Apache-2.0
#include "temporal/display_instant.h"

#include <cmath>

namespace viewloom {

ShownInstant shownTo(const DisplaySpec& spec, const CameraMotion& motion, int64_t server_ns) {
  if (spec.world_pose && !motion.movesThings()) {
    return {.time_ns = motion.captured_ns,
            .timing = Timing::kCaptured,
            .source_pose = motion.camera.pose};
  }
  const int64_t bridge_ns = std::llround(1e9 * spec.temporal->bridge_s);
  ShownInstant shown = spec.temporal->mode == TemporalMode::kInterpolate
                           ? interpolated(motion, server_ns, bridge_ns)
                           : predicted(motion, server_ns, bridge_ns);
  if (spec.world_pose) shown.source_pose = motion.camera.pose;
  return shown;
}

}  // namespace viewloom
