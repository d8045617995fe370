// SPDX-License-Identifier: Apache-2.0
// The eyes of one web client that watches a tracked display.
#pragma once

#include <cstdint>
#include <optional>

#include "base/status.h"
#include "display/display_spec.h"
#include "encode/encoded_band.h"
#include "eye_poses/eye_track.h"
#include "eye_poses/sent_poses.h"
#include "viewloom/v1/display_service.pb.h"
#include "web/web_context.h"

namespace viewloom {

// Takes poses in, and learns from the client when it saw what they gave. Thread-safety: none.
class ViewerEyes {
 public:
  explicit ViewerEyes(WebContext& context) : context_(context) {}

  // The track of a display that would take the place of the watched one (trackOf).
  EyeTrackPtr trackFor(const DisplaySpec& display) const { return trackOf(display, track_); }
  // Another display is watched from now on. `track`: as trackFor() gave it.
  void watch(const DisplaySpec& display, uint64_t display_id, EyeTrackPtr track);

  // FAILED_PRECONDITION if the display is not tracked; INVALID_ARGUMENT for eyes that see nothing.
  absl::Status take(const v1::EyePoses& request);
  void noteSent(const EncodedAtlas& atlas);
  void notePresented(const v1::Presented& presented) const;

 private:
  WebContext& context_;
  std::optional<DisplaySpec> display_;  // that is watched
  uint64_t display_id_ = 0;
  EyeTrackPtr track_;  // of a tracked display
  SentPoses sent_;
};

}  // namespace viewloom
