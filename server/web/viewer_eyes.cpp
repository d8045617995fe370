// SPDX-License-Identifier: Apache-2.0
#include "web/viewer_eyes.h"

#include <utility>

#include "display/tracked_eyes.h"
#include "messages/eye_poses_from_proto.h"
#include "publish/eye_intake.h"

namespace viewloom {

void ViewerEyes::watch(const DisplaySpec& display, uint64_t display_id, EyeTrackPtr track) {
  display_ = display;
  display_id_ = display_id;
  track_ = std::move(track);
  sent_.clear();
}

absl::Status ViewerEyes::take(const v1::EyePoses& request) {
  if (track_ == nullptr) {
    return fieldError(absl::StatusCode::kFailedPrecondition, "eye_poses",
                      "eye poses came for a display that does not track eyes; accepted are they "
                      "for a StereoDisplay with tracked set");
  }
  absl::StatusOr<EyePoses> poses = eyePosesFromProto(request, trackedEyeCount(*display_));
  VIEWLOOM_RETURN_IF_ERROR(poses.status());
  poses->received_ns = context_.clock.nowNs();
  return takeEyePoses(*std::move(poses), {*display_, display_id_, *track_}, context_.broadcaster,
                      context_.eyes);
}

void ViewerEyes::noteSent(const EncodedAtlas& atlas) {
  sent_.note(atlas.sequence, atlas.eye_poses_time_ns);
}

void ViewerEyes::notePresented(const v1::Presented& presented) const {
  context_.metrics.atlases_presented.add();
  const std::optional<double> latency_s =
      sent_.latencySeconds(presented.sequence(), presented.presented_time_ns());
  if (latency_s) context_.metrics.motion_to_image.observe(*latency_s);
}

}  // namespace viewloom
