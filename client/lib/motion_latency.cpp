// SPDX-License-Identifier: Apache-2.0
#include "lib/motion_latency.h"

namespace viewloom {

std::optional<MotionLatency> motionLatency(const Atlas& atlas, int64_t measured_ns,
                                           int64_t shown_ns, const ClockOffset& server) {
  const v1::AtlasHeader& header = atlas.header;
  const v1::StageTimes& times = atlas.end.times();
  if (header.eye_poses_latched_ns() == 0) return std::nullopt;
  // As floating point: whatever a server says, nothing overflows.
  const auto seconds = [](double duration_ns) { return duration_ns * 1e-9; };
  const double latched_ns = double(header.eye_poses_latched_ns()) - double(server.ahead_ns);
  MotionLatency latency;
  latency.total_s = seconds(double(shown_ns) - double(measured_ns));
  latency.waited_s = seconds(double(header.eye_poses_age_ns()));
  latency.made_s = seconds(double(times.trace_ns()) + double(times.encode_ns()));
  latency.to_server_s = seconds(latched_ns - double(measured_ns)) - latency.waited_s;
  latency.back_s = seconds(double(shown_ns) - latched_ns) - latency.made_s;
  return latency;
}

}  // namespace viewloom
