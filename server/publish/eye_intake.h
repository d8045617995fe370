// SPDX-License-Identifier: Apache-2.0
// The way of eye poses from a viewer to the tracked display that it watches.
#pragma once

#include <cstdint>

#include "base/status.h"
#include "display/display_spec.h"
#include "eye_poses/eye_track.h"
#include "publish/broadcaster.h"

namespace viewloom {

// A tracked display that one viewer watches.
struct TrackedDisplay {
  const DisplaySpec& spec;  // completed
  uint64_t id = 0;          // in the broadcaster
  EyeTrack& track;
};

// Puts poses into the track of the display, and tells `sink`. Poses that wait there are replaced.
// INVALID_ARGUMENT for eyes that do not stand in front of the focal plane. Where the stream has to
// give that plane, it is not known before the first frame: the trace checks again.
// Thread-safety: may be called from any thread.
absl::Status takeEyePoses(EyePoses poses, const TrackedDisplay& display,
                          const Broadcaster& broadcaster, EyeSink& sink);

}  // namespace viewloom
