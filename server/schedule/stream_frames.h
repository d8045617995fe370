// SPDX-License-Identifier: Apache-2.0
// The frames of one stream on their way to become resident: which is built next, which says nothing
// new, and what a built one tells of the stream.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "display/taken_defaults.h"
#include "publish/broadcaster.h"
#include "schedule/frame_ticket.h"
#include "schedule/resident_structure.h"
#include "temporal/camera_track.h"

namespace viewloom {

struct OfferedFrame {
  FramePtr frame;
  uint64_t session = 0;  // see FrameOrigin
  FrameTicketPtr ticket;
};

// Some of these displays shows what lies between frames.
bool showBetweenFrames(const std::vector<ActiveDisplayPtr>& displays);

// Thread-safety: none; the structure loop's.
class StreamFrames {
 public:
  // A newer frame came, which is next from now on. Returns the one that it replaces. The camera and
  // the clock of a publisher say nothing about those of another.
  [[nodiscard]] std::optional<OfferedFrame> offer(OfferedFrame frame);
  // The frame that is to be built; nullptr = there is none.
  const OfferedFrame* next() const { return next_ ? &*next_ : nullptr; }
  // Expects that there is one.
  OfferedFrame takeNext();

  // How the camera moves by now, if the next frame is the resident one once more and nothing is to
  // be made of it. It is compared with the resident frame, not with the last: that may have been
  // replaced or refused. The first frame of a new session is built where the defaults are to be
  // taken from it. Expects a next frame.
  std::optional<CameraMotion> followUnchanged(const ResidentStructure& resident, int64_t now_ns);

  // Gives the structure the defaults of the stream, from the frame that was taken or from an
  // earlier one. Returns a note for people where they are others than before.
  std::optional<std::string> takeDefaults(uint64_t session, ResidentStructure& structure);
  // The frame that was taken is resident from now on. `before`: the structure that was resident.
  // `keeps_before`: some display shows what lies between the two.
  StreamInstant becomeResident(FramePtr frame, ResidentPtr structure, ResidentPtr before,
                               bool keeps_before);

 private:
  std::optional<OfferedFrame> next_;
  uint64_t session_ = 0;    // of the publisher, as the newest frame says
  FramePtr resident_;       // the resident structure was made of it
  TakenDefaults defaults_;  // of the frames that were resident
  CameraTrack track_;       // of the session's frames, resident or equal to it
};

}  // namespace viewloom
