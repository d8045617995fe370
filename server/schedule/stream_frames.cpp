// SPDX-License-Identifier: Apache-2.0
#include "schedule/stream_frames.h"

#include <algorithm>
#include <utility>

#include "base/check.h"
#include "base/str_cat.h"
#include "frame/same_content.h"

namespace viewloom {
namespace {

TrackedFrame trackedFrame(const Frame& frame, const Frame* before, const SourceStats& stats,
                          int64_t built_ns) {
  TrackedFrame tracked = trackedFrame(frame, before, stats.inv_z_near);
  tracked.arrived_ns = frame.times.first_chunk_ns;
  tracked.built_ns = built_ns;
  return tracked;
}

}  // namespace

bool showBetweenFrames(const std::vector<ActiveDisplayPtr>& displays) {
  return std::ranges::any_of(displays, [](const ActiveDisplayPtr& display) {
    return display->spec.temporal && display->spec.temporal->mode == TemporalMode::kInterpolate;
  });
}

std::optional<OfferedFrame> StreamFrames::offer(OfferedFrame frame) {
  std::optional<OfferedFrame> replaced = std::exchange(next_, std::move(frame));
  if (next_->session != session_) track_ = {};
  session_ = next_->session;
  return replaced;
}

OfferedFrame StreamFrames::takeNext() {
  VIEWLOOM_CHECK(next_.has_value());
  return *std::exchange(next_, std::nullopt);
}

std::optional<CameraMotion> StreamFrames::followUnchanged(const ResidentStructure& resident,
                                                          int64_t now_ns) {
  VIEWLOOM_CHECK(next_.has_value());
  if (!resident_ || !haveSameContent(*resident_, *next_->frame)) return std::nullopt;
  if (defaults_.isBegunBy(session_, resident.stats)) return std::nullopt;
  defaults_.follow(session_, resident.stats, resident.built_at_ns);
  return track_.add(trackedFrame(*next_->frame, resident_.get(), resident.stats, now_ns));
}

std::optional<std::string> StreamFrames::takeDefaults(uint64_t session,
                                                      ResidentStructure& structure) {
  const std::string before = defaults_.taking().count == 0 ? "" : depthRangeText(defaults_.stats());
  const bool are_taken = defaults_.follow(session, structure.stats, structure.built_at_ns);
  const SeenSource& first = structure.sources.front();
  structure.defaults = streamDefaults(first.camera.intrinsics, first.size_px, defaults_.stats());
  structure.taking = defaults_.taking();
  if (!are_taken || before.empty()) return std::nullopt;
  const bool has_moved = structure.taking.reason == DefaultsReason::kDepthMoved;
  return strCat(has_moved ? "" : "a new publisher: ", "depth was ", before, " and is ",
                depthRangeText(structure.stats),
                "; focal plane, depth range and aperture are taken anew from this frame, where a "
                "display leaves them open");
}

StreamInstant StreamFrames::becomeResident(FramePtr frame, ResidentPtr structure,
                                           ResidentPtr before, bool keeps_before) {
  const CameraMotion& motion =
      track_.add(trackedFrame(*frame, resident_.get(), structure->stats, structure->built_at_ns));
  resident_ = std::move(frame);
  // A camera that stands has seen nothing else a frame ago.
  const bool has_moved = motion.isMoving() && motion.interval_ns > 0;
  return {std::move(structure), motion, has_moved && keeps_before ? std::move(before) : nullptr};
}

}  // namespace viewloom
