// SPDX-License-Identifier: Apache-2.0
// Gives displays with an output rate of their own an atlas at each of their ticks.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "pipeline/pipeline_links.h"
#include "pipeline/wake_up.h"
#include "schedule/tick_schedule.h"

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
  void run(const std::stop_token& stop);
  std::vector<TickSchedule::DueTick> takeDue();
  std::optional<int64_t> soonestNs();
  void offerTick(TickSchedule::DueTick& due);

  const PipelineLinks& links_;
  const OfferTick offer_tick_;
  WakeUp wake_up_;
  std::mutex mutex_;
  TickSchedule schedule_;  // guarded by mutex_
  std::jthread thread_;    // last: it uses all of the above
};

}  // namespace viewloom
