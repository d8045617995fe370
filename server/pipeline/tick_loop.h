// SPDX-License-Identifier: Apache-2.0
// Gives displays with an output rate of their own an atlas at each of their ticks.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "pipeline/job_queue.h"
#include "pipeline/pipeline_links.h"
#include "pipeline/stream_table.h"
#include "pipeline/wake_up.h"
#include "temporal/output_rate.h"

namespace viewloom {

// One thread, asleep while there are no such displays. A tick at which the picture's last atlas is
// still on its way is skipped, and counted; what would show nothing new is not traced.
// Thread-safety: offer() and giveBack() from any thread; stop() from one thread, once.
class TickLoop {
 public:
  // Hands on the job of a picture, of such displays; false while an atlas of it is on its way. Must
  // not wait for anything: the ticks of all displays are behind it.
  using OfferTick = std::function<bool(const AtlasJob& job, const ActiveDisplayPtr& display)>;

  TickLoop(const PipelineLinks& links, OfferTick offer_tick);
  ~TickLoop() { stop(); }

  // A stream has a newer structure, its camera moves otherwise, or its displays have changed. The
  // ticket, of the structure's frame, goes with the next tick of each picture.
  void offer(const std::string& stream, const StreamInstant& newest, const FrameTicketPtr& ticket);
  // The job of a tick that was handed on, of which no atlas comes after all: the tick counts as
  // skipped.
  void giveBack(AtlasJob job);
  void stop();

 private:
  struct Picture {
    ActiveDisplayPtr display;  // one of those that share it
    OutputClock clock;
    FrameTicketPtr ticket;
  };
  using Tickets = std::vector<FrameTicketPtr>;
  struct DueTick {
    ActiveDisplayPtr display;
    AtlasJob job;
    uint64_t missed_count = 0;
  };

  void run(const std::stop_token& stop);
  std::vector<DueTick> takeDue();
  std::optional<int64_t> soonestNs();
  void noteDisplays(const std::string& stream, Tickets& released);
  void offerTick(DueTick& due);

  const PipelineLinks& links_;
  const OfferTick offer_tick_;
  WakeUp wake_up_;
  std::mutex mutex_;                              // guards what follows
  std::map<std::string, StreamInstant> streams_;  // with such displays
  std::map<std::string, Picture> pictures_;       // by picture_key
  std::jthread thread_;                           // last: it uses all of the above
};

}  // namespace viewloom
