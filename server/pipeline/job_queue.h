// SPDX-License-Identifier: Apache-2.0
// Which atlas is traced next: soonest deadline first, newest structure of each picture; of tracked
// displays one whose eyes have just moved.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/frame_ticket.h"
#include "pipeline/resident_structure.h"
#include "publish/eye_track.h"
#include "temporal/camera_motion.h"

namespace viewloom {

// What a display with a rate of its own wants at one of its ticks.
struct OutputTick {
  int64_t due_ns = 0;  // server's monotonic clock
  ShownInstant shown;
  int64_t frames_apart_ns = 0;  // the newest and the one before, by the publisher's clock
};

// An atlas to be made: one picture, from one structure. Displays with equal picture_key share it.
struct AtlasJob {
  std::string picture_key;
  ResidentPtr structure;
  int64_t deadline_ns = 0;   // server's monotonic clock
  FrameTicketPtr ticket;     // of the structure's frame; nullptr when the frame is reported already
  bool is_for_eyes = false;  // that have moved since the display was given this structure
  bool is_tracked = false;   // of a tracked display
  PoseTimes poses = {};      // of its eyes
  std::optional<OutputTick> tick = std::nullopt;  // none = the frame as it came
  ResidentPtr before = nullptr;  // also asked: what it has seen a frame ago, from elsewhere
};

// Poses that came so close together are as good as each other, however fast they come: a small part
// of the interval of any headset.
inline constexpr int64_t kAlikePoses_ns = 500'000;

// How often all tracked displays may go before one that waits, which then goes first whatever the
// age of its poses. So seldom that no p99 tells: were it chance whose poses are fresh, one wait in
// e^5 = 148 would be as long. Of eight heads that move at random times, 2.4 of them answered in
// an interval of 90 Hz, the p99 of age is in the median of 50 sets 4.3 ms with 5, 5.6 with 3 and
// 8.9 with 2, and none is passed over more than 36, 23 and 16 times (moving_heads_test's server).
inline constexpr uint32_t kRoundsPassed = 5;

// Jobs that have not begun, at most one per picture.
//
// When more heads move than there are answers for, not all poses get one, and who is next decides
// how old those are that do. Heads whose poses are fresh go first: those of all others are soon
// replaced. Of n heads that wait, poses are fresh for an nth of the interval in which they come, as
// then about one of the heads has some; so are any within kAlikePoses_ns of the freshest, and those
// that nothing has followed for two intervals. Of these heads the one with the soonest deadline is
// next: it has waited longest. One that others have gone before kRoundsPassed * n times is next in
// any case. So none is passed over more than (kRoundsPassed + 1) * n - 1 times: the n - 1 others
// may be as late.
//
// Thread-safety: none; the trace loop's.
class JobQueue {
 public:
  // Of two jobs for the same picture the one with the newer structure stays and takes the sooner
  // deadline, so that a picture with ever newer structures is not put off for ever; the other one
  // is returned. With the same structure the two become one.
  std::optional<AtlasJob> push(AtlasJob job);

  size_t waitingCount() const { return waiting_.size(); }
  // A job of the picture waits, or has begun.
  bool isBusy(const std::string& picture_key) const;

  // The soonest deadline of a job that may begin; none while its picture is being traced.
  std::optional<int64_t> soonestDeadlineNs() const;
  // Whether one of a tracked display may begin, and whether the soonest is one.
  bool hasTracked() const;
  bool isSoonestTracked() const;
  // Takes the soonest job, or of tracked displays the one that is next by now; no other of its
  // picture may begin until finish().
  AtlasJob begin();
  AtlasJob beginTracked(int64_t now_ns);
  void finish(const std::string& picture_key);
  // Forgets the jobs that have not begun.
  std::vector<AtlasJob> clear();

 private:
  struct Waiting {
    AtlasJob job;
    size_t passed_count = 0;  // of tracked displays that have begun before it, and might not have
  };

  bool mayBegin(const Waiting& waiting) const;
  bool mayBeginTracked(const Waiting& waiting) const;
  // Of those that count, or of all that may begin; nullptr = none.
  template <typename Counts>
  const Waiting* soonest(const Counts& counts) const;
  const Waiting* soonest() const;
  const Waiting* nextTracked(int64_t now_ns) const;
  AtlasJob take(const Waiting* waiting);

  std::vector<Waiting> waiting_;
  std::set<std::string> begun_;
};

}  // namespace viewloom
