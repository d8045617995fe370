// SPDX-License-Identifier: Apache-2.0
#include "temporal/output_rate.h"

#include <cmath>

namespace viewloom {

int64_t OutputClock::tickNs(uint64_t index) const {
  return start_ns_ + std::llround(1e9 * double(index) / rate_hz_);
}

std::optional<OutputClock::Tick> OutputClock::take(int64_t now_ns) {
  if (now_ns < dueNs()) return std::nullopt;
  auto newest = uint64_t(1e-9 * double(now_ns - start_ns_) * rate_hz_);
  // The quotient may be off by a rounding on either side of a tick.
  while (newest > next_ && tickNs(newest) > now_ns) --newest;
  while (newest < next_ || tickNs(newest + 1) <= now_ns) ++newest;
  const Tick tick{.due_ns = tickNs(newest), .missed_count = newest - next_};
  next_ = newest + 1;
  return tick;
}

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
