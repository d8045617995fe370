// SPDX-License-Identifier: Apache-2.0
// The ticks of displays with an output rate of their own: when each is due, and what it shows.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "schedule/atlas_job.h"
#include "temporal/output_rate.h"

namespace viewloom {

// Times are of the server's monotonic clock. Thread-safety: none.
class TickSchedule {
 public:
  struct DueTick {
    ActiveDisplayPtr display;   // one of those that share the picture
    AtlasJob job;               // without a deadline
    uint64_t missed_count = 0;  // earlier ticks of the picture that are skipped for this one
  };
  struct Noted {
    bool is_news = false;  // displays tick to what was noted
    // Tickets that no tick needs any more. They may report when they are let go: whoever holds a
    // lock waits with that until it is free.
    std::vector<FrameTicketPtr> released;
  };

  // A stream has a newer structure, its camera moves otherwise, or its displays are others now. The
  // first tick of a new picture is due at once. The ticket, of the structure's frame, goes with the
  // next tick of each picture. A structure older than the one known changes displays alone.
  [[nodiscard]] Noted note(const std::string& stream, const std::vector<ActiveDisplayPtr>& displays,
                           const StreamInstant& newest, const FrameTicketPtr& ticket,
                           int64_t now_ns);

  // When the next tick is due; empty while there are no displays that tick.
  std::optional<int64_t> soonestNs() const;
  // Takes the newest tick of each picture that has one due.
  std::vector<DueTick> takeDue(int64_t now_ns);
  // No atlas comes of a tick that was taken: its ticket waits for the next one, unless that is of a
  // newer frame. A ticket that is to be let go is left in the job.
  void giveBack(AtlasJob& job);

 private:
  struct Picture {
    ActiveDisplayPtr display;  // one of those that share it
    OutputClock clock;
    FrameTicketPtr ticket;
  };

  void noteDisplays(const std::string& stream, const std::vector<ActiveDisplayPtr>& displays,
                    int64_t now_ns, std::vector<FrameTicketPtr>& released);

  std::map<std::string, StreamInstant> streams_;  // with such displays
  std::map<std::string, Picture> pictures_;       // by picture_key
};

}  // namespace viewloom
