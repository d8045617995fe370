// SPDX-License-Identifier: Apache-2.0
#include "lib/latency.h"

#include "absl/numeric/int128.h"

namespace viewloom {
namespace {

// Beyond this the publisher's clock is not ours, and their difference is no latency.
constexpr double kLatencyMax_s = 60;
constexpr double kStandingMin_s = 2;

// In more than 64 bits: capture times are anybody's.
double secondsBetween(int64_t from_ns, int64_t to_ns) {
  return static_cast<double>(absl::int128(to_ns) - absl::int128(from_ns)) * 1e-9;
}

}  // namespace

void FrameLatency::note(uint64_t frame_number, int64_t capture_time_ns, int64_t now_ns) {
  const Frame frame{.number = frame_number, .capture_time_ns = capture_time_ns};
  const bool is_first = !newest_;
  // A frame that is sent again with its old capture time stands too; 0 = it was not given.
  const bool is_sent_again =
      newest_ && capture_time_ns != 0 && newest_->capture_time_ns == capture_time_ns;
  const bool stands = newest_ && (newest_->number == frame.number || is_sent_again);
  if (stands) return;
  newest_ = frame;
  came_ns_ = now_ns;
  latency_s_.reset();
  const double latency_s = secondsBetween(capture_time_ns, now_ns);
  if (!is_first && latency_s >= 0 && latency_s < kLatencyMax_s) latency_s_ = latency_s;
}

std::optional<double> FrameLatency::standing_s(int64_t now_ns) const {
  const double standing_s = secondsBetween(came_ns_, now_ns);
  if (!newest_ || standing_s < kStandingMin_s) return std::nullopt;
  return standing_s;
}

std::optional<MotionLatency> motionLatency(const Atlas& atlas, int64_t measured_ns,
                                           int64_t shown_ns, const ClockOffset& server) {
  const v1::AtlasHeader& header = atlas.header;
  const v1::StageTimes& times = atlas.end.times();
  if (header.eye_poses_latched_ns() == 0) return std::nullopt;
  // In floating point nothing overflows, whatever a server says.
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
