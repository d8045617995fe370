// SPDX-License-Identifier: Apache-2.0
// An atlas that is to be made: of which structure, for which picture, and until when.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eye_poses/eye_track.h"
#include "publish/broadcaster.h"
#include "schedule/fair_shares.h"
#include "schedule/frame_ticket.h"
#include "schedule/resident_structure.h"

namespace viewloom {

// Tracked displays are due by so much before their time: so long others may be overdue until they
// begin before them.
inline constexpr int64_t kEyesAhead_ns = 1'000'000'000;

// An atlas is due after the time that its rays should take, so that a small one overtakes a large
// one.
inline constexpr int64_t kDueNsPerRay = 10;

// A display with a rate of its own at one of its ticks.
struct OutputTick {
  int64_t due_ns = 0;  // server's monotonic clock
  ShownInstant shown;
  int64_t frames_apart_ns = 0;  // the newest and the one before, by the publisher's clock
};

// One picture, from one structure. Displays with equal picture_key share it.
struct AtlasJob {
  std::string picture_key;
  ResidentPtr structure;
  int64_t deadline_ns = 0;   // server's monotonic clock
  FrameTicketPtr ticket;     // of the structure's frame; nullptr when the frame is reported already
  bool is_for_eyes = false;  // that have moved since the display was given this structure
  bool is_tracked = false;   // of a tracked display
  PoseTimes poses = {};      // of its eyes
  std::optional<OutputTick> tick = std::nullopt;  // none = the frame as it came
  int64_t asked_ns = 0;                           // when it was first offered
  ResidentPtr before = nullptr;  // also asked: what it has seen a frame ago, from elsewhere
  Payers payers = {};            // the viewers of its displays
};

// Lets these pay, too.
void addPayers(const Payers& more, Payers& payers);

// The job's claim on the engines' time.
Claim claimOf(const AtlasJob& job);

// Whether the job asks for the newest frame of its stream, if it has nothing new to show when it is
// its turn. Eyes wait for nothing, and ticks show frames as they are.
bool asksForNewer(const AtlasJob& job);

// Jobs that ask for a frame that waits to be let in, when it is their turn. `resident`: of the
// stream, which the displays have seen or will.
std::vector<AtlasJob> jobsForWaiting(const ResidentPtr& resident,
                                     const std::vector<ActiveDisplayPtr>& displays, int64_t now_ns);

// Whether a frame loses a picture with this job, rather than a picture its turn.
inline bool losesPicture(const std::optional<AtlasJob>& replaced) {
  return replaced && replaced->ticket != nullptr;
}

// Deadline of an atlas that is wanted from now on.
int64_t deadlineNs(const DisplaySpec& spec, int64_t now_ns);

// A job for each picture of these displays of the stream, except those that wait for their ticks.
// The ticket is of the structure's frame, if that has not been reported.
std::vector<AtlasJob> jobsOfFrame(const ResidentPtr& structure,
                                  const std::vector<ActiveDisplayPtr>& displays,
                                  const FrameTicketPtr& ticket, int64_t now_ns);

// The eyes before a tracked display have moved since it was given the structure.
AtlasJob jobForEyes(const ActiveDisplay& display, ResidentPtr structure, int64_t now_ns);

}  // namespace viewloom
