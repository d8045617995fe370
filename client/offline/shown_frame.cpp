// SPDX-License-Identifier: Apache-2.0
#include "offline/shown_frame.h"

#include <cmath>
#include <memory>
#include <utility>

#include "base/status.h"
#include "base/str_cat.h"
#include "base/worker_pool.h"
#include "picture/display_sources.h"
#include "temporal/camera_track.h"
#include "temporal/output_rate.h"

namespace viewloom {
namespace {

// Limit of a time after a frame: in ns, added to any time of this age, it fits.
constexpr double kLaterMax_s = 1e6;

// The frame before is uploaded with the newest one, as sources of one frame.
absl::Status checkLight(const FramesAtHand& frames) {
  const FrameFormat& newest = frames.newest->format;
  const FrameFormat& before = frames.before->format;
  if (newest.exposure_ev != before.exposure_ev) {
    return invalidField("exposure_ev", strCat("got ", newest.exposure_ev,
                                              ", accepted to interpolate is that of the frame "
                                              "before, ",
                                              before.exposure_ev));
  }
  if (newest.tone_map == before.tone_map) return absl::OkStatus();
  return invalidField("tone_map",
                      "differs from that of the frame before, between which and this "
                      "one it is to interpolate");
}

absl::Status checkTime(const FramesAtHand& frames, TemporalMode mode, double later_s) {
  if (!(std::abs(later_s) <= kLaterMax_s)) {
    return invalidField("--later", strCat("got ", later_s, ", accepted is up to ", kLaterMax_s));
  }
  const int64_t newest_ns = frames.newest->format.capture_time_ns;
  if (frames.before && frames.before->format.capture_time_ns >= newest_ns) {
    return invalidField("capture_time_ns",
                        strCat("got ", newest_ns, ", accepted is later than ",
                               frames.before->format.capture_time_ns, " of the frame before"));
  }
  if (mode == TemporalMode::kPredict) {
    if (later_s >= 0) return absl::OkStatus();
    return invalidField("--later", strCat("got ", later_s, ", accepted is 0 or more to predict"));
  }
  if (!frames.before) {
    return invalidField("--before", "is missing, to interpolate takes two frames");
  }
  VIEWLOOM_RETURN_IF_ERROR(checkLight(frames));
  const double interval_s =
      1e-9 * (double(newest_ns) - double(frames.before->format.capture_time_ns));
  if (later_s <= 0 && later_s >= -interval_s) return absl::OkStatus();
  return invalidField("--later", strCat("got ", later_s, ", accepted is ", -interval_s,
                                        "..0 to interpolate between these frames"));
}

}  // namespace

FramePtr carriedFrame(FrameRetimer& retimer, const FramePtr& frame, int64_t carried_ns,
                      const std::vector<ThingPose>& things, Guesses guesses) {
  const FramePtr retimed =
      carried_ns == 0 ? frame : retimer.retime(frame, 1e-9 * double(carried_ns), guesses);
  auto carried = std::make_shared<Frame>(*retimed);
  for (const ThingPose& thing : things) {
    carried->format.sources[thing.source].camera.pose = thing.pose;
  }
  return carried;
}

FramePtr joinedFrames(const Frame& newest, const Frame& before) {
  auto both = std::make_shared<Frame>(newest);
  const auto append = [](const auto& from, auto& to) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(before.format.sources, both->format.sources);
  append(before.sources, both->sources);
  return both;
}

absl::StatusOr<ShownFrame> showBetween(const FramesAtHand& frames, const DisplaySpec& spec,
                                       double later_s) {
  VIEWLOOM_RETURN_IF_ERROR(checkTime(frames, spec.temporal->mode, later_s));
  CameraTrack track;
  if (frames.before) track.add(trackedFrame(*frames.before, nullptr, frames.inv_z_near));
  const CameraMotion motion =
      track.add(trackedFrame(*frames.newest, frames.before.get(), frames.inv_z_near));
  const int64_t time_ns = motion.captured_ns + std::llround(1e9 * later_s);
  const bool lags = spec.temporal->mode == TemporalMode::kInterpolate;
  const ShownInstant shown = shownTo(spec, motion, time_ns + (lags ? motion.lag_ns : 0));
  const bool asks_both =
      lags && motion.isMoving() && motion.interval_ns > 0 &&
      canMerge(spec, frames.newest->sources.size() + frames.before->sources.size());
  const Guesses guesses = asks_both ? Guesses::kGiveWay : Guesses::kStand;
  WorkerPool workers;
  const auto carried = [&](const FramePtr& frame, int64_t carried_ns) {
    FrameRetimer retimer(workers);
    return carriedFrame(retimer, frame, carried_ns, shown.things, guesses);
  };
  ShownFrame result{.frame = carried(frames.newest, shown.carried_ns),
                    .source_pose = shown.source_pose,
                    .timing = shown.timing};
  if (!asks_both) return result;
  const int64_t since_before_ns = motion.things_move ? shown.carried_ns + motion.interval_ns : 0;
  result.frame = joinedFrames(*result.frame, *carried(frames.before, since_before_ns));
  return result;
}

}  // namespace viewloom
