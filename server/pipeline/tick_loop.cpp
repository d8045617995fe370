// SPDX-License-Identifier: Apache-2.0
#include "pipeline/tick_loop.h"

#include <utility>

#include "base/log.h"
#include "base/thread_name.h"
#include "pipeline/within_memory.h"

namespace viewloom {

TickLoop::TickLoop(const PipelineLinks& links, OfferTick offer_tick)
    : links_(links), offer_tick_(std::move(offer_tick)), thread_([this](const auto& stop) {
        nameThread("ticks");
        try {
          run(stop);
        } catch (const std::exception& error) {
          links_.on_failure(error);
        }
      }) {}

void TickLoop::stop() {
  thread_.request_stop();
  wake_up_.ring();
  if (thread_.joinable()) thread_.join();
  TickSchedule dropped;  // let go after the lock: its tickets may report
  std::lock_guard lock(mutex_);
  std::swap(dropped, schedule_);
}

void TickLoop::offer(const std::string& stream, const StreamInstant& newest,
                     const FrameTicketPtr& ticket) {
  TickSchedule::Noted noted;  // its tickets are let go after the lock: they may report
  {
    std::lock_guard lock(mutex_);
    // Displays are listed under the lock: an older list must not overtake a newer one.
    noted = schedule_.note(stream, links_.broadcaster.displays(stream), newest, ticket,
                           links_.clock.nowNs());
  }
  if (noted.is_news) wake_up_.ring();
}

void TickLoop::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const absl::Status status = withinMemory([this] {
      for (TickSchedule::DueTick& due : takeDue()) offerTick(due);
    });
    if (!status.ok()) log(LogLevel::kWarning, "ticks are left out: ", status.message());
    std::optional<std::chrono::nanoseconds> nap;
    if (const std::optional<int64_t> due_ns = soonestNs()) nap = links_.clock.napUntil(*due_ns);
    wake_up_.wait(nap);
  }
}

std::optional<int64_t> TickLoop::soonestNs() {
  std::lock_guard lock(mutex_);
  return schedule_.soonestNs();
}

std::vector<TickSchedule::DueTick> TickLoop::takeDue() {
  std::lock_guard lock(mutex_);
  return schedule_.takeDue(links_.clock.nowNs());
}

void TickLoop::offerTick(TickSchedule::DueTick& due) {
  if (due.missed_count > 0) links_.metrics.output_ticks_skipped.add(double(due.missed_count));
  if (!offer_tick_(due.job, due.display)) giveBack(std::move(due.job));
}

// A ticket that stays in the job is let go after the lock: it may report.
void TickLoop::giveBack(AtlasJob job) {
  links_.metrics.output_ticks_skipped.add();
  std::lock_guard lock(mutex_);
  schedule_.giveBack(job);
}

}  // namespace viewloom
