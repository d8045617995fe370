// SPDX-License-Identifier: Apache-2.0
// Ticks that show things which have gone on by themselves: of which times, and which is next.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "schedule/atlas_job.h"

namespace viewloom {

// Whether the job's tick lies between its frames: something that moves by itself has gone on.
bool isRetimed(const AtlasJob& job);

// For how long things go on, from each structure of the job to the time that its tick shows.
struct RetimeDates {
  int64_t newest_ns = 0;
  std::optional<int64_t> before_ns;  // none = that structure stays, or there is none
};
RetimeDates retimeDatesOf(const AtlasJob& job);

// Ticks of one stream are served one after the other, the picture that waits longest first. Of a
// picture no more than one tick waits, the newest. Jobs that are let go may report their tickets:
// whoever holds a lock waits with that until it is free. Thread-safety: none.
class RetimeSchedule {
 public:
  struct Tick {
    AtlasJob job;
    ActiveDisplayPtr display;
  };

  // Outcome of an offer.
  struct Offered {
    // False, and the tick is skipped, while its picture is being served, or waits for what is being
    // made for another one.
    bool is_taken = false;
    std::optional<Tick> replaced;  // skipped for this one
  };
  // The job stays where it is unless it is taken.
  [[nodiscard]] Offered offer(AtlasJob&& job, const ActiveDisplayPtr& display);
  // A tick of the picture waits or is being served.
  bool isBusy(const AtlasJob& job) const;

  // Takes the next tick of a stream of which none is being served. Empty: all have to wait.
  std::optional<Tick> take();
  // The tick of the stream that was taken is served. Returns what is left of its job.
  [[nodiscard]] std::optional<AtlasJob> finish(const std::string& stream);
  // Streams that have ticks: so many can be served at a time.
  size_t streamCount() const { return streams_.size(); }

 private:
  struct Stream {
    std::vector<Tick> waiting;        // one of each picture, longest waiting first
    std::optional<AtlasJob> in_hand;  // without its ticket
  };

  std::map<std::string, Stream> streams_;  // by name, those that have ticks
};

}  // namespace viewloom
