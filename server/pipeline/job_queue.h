// SPDX-License-Identifier: Apache-2.0
// Which atlas is traced next: soonest deadline first, newest structure of each picture.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/frame_ticket.h"
#include "pipeline/resident_structure.h"
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
  std::optional<OutputTick> tick = std::nullopt;  // none = the frame as it came
  ResidentPtr before = nullptr;  // also asked: what it has seen a frame ago, from elsewhere
};

// Jobs that have not begun, at most one per picture. Thread-safety: none; the trace loop's.
class JobQueue {
 public:
  // Of two jobs for the same picture the one with the newer structure stays and takes the sooner
  // deadline, so that a picture with ever newer structures is not put off for ever; the other one
  // is returned. With the same structure the two become one.
  std::optional<AtlasJob> push(AtlasJob job);

  // A job of the picture waits, or has begun.
  bool isBusy(const std::string& picture_key) const;

  // The soonest deadline of a job that may begin; none while its picture is being traced.
  std::optional<int64_t> soonestDeadlineNs() const;
  // Whether one of a tracked display may begin.
  bool hasTracked() const;
  // Takes that job; no other of its picture may begin until finish().
  AtlasJob begin();
  void finish(const std::string& picture_key);
  // Forgets the jobs that have not begun.
  std::vector<AtlasJob> clear();

 private:
  std::vector<AtlasJob>::const_iterator soonest() const;

  std::vector<AtlasJob> waiting_;
  std::set<std::string> begun_;
};

}  // namespace viewloom
