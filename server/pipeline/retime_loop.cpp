// SPDX-License-Identifier: Apache-2.0
#include "pipeline/retime_loop.h"

#include <exception>
#include <utility>

#include "admission/request_boundary.h"
#include "base/thread_name.h"

namespace viewloom {

RetimeLoop::RetimeLoop(const Metrics& metrics, Serve serve)
    : metrics_(metrics), serve_(std::move(serve)) {}

void RetimeLoop::stop() {
  {
    std::lock_guard lock(mutex_);
    stop_.request_stop();  // no thread is made any more
  }
  changed_.notify_all();
  threads_.clear();
  RetimeSchedule dropped;  // let go after the lock: its tickets may report
  std::lock_guard lock(mutex_);
  std::swap(dropped, schedule_);
}

bool RetimeLoop::offer(AtlasJob job, const ActiveDisplayPtr& display) {
  RetimeSchedule::Offered offered;  // let go after the lock: a ticket may report
  {
    std::lock_guard lock(mutex_);
    if (stop_.stop_requested()) return false;
    offered = schedule_.offer(std::move(job), display);
    if (!offered.is_taken) return false;
    if (offered.replaced) metrics_.output_ticks_skipped.add();
    if (threads_.size() < schedule_.streamCount()) {
      threads_.emplace_back([this] {
        nameThread("retime");
        run();
      });
    }
  }
  changed_.notify_one();
  return true;
}

bool RetimeLoop::isBusy(const AtlasJob& job) {
  std::lock_guard lock(mutex_);
  return schedule_.isBusy(job);
}

void RetimeLoop::run() {
  while (std::optional<RetimeSchedule::Tick> tick = take()) {
    const ResidentPtr structure = tick->job.structure;
    try {
      serve_(std::move(tick->job), tick->display->spec, stop_.get_token());
    } catch (const std::exception& thrown) {
      noteThrown("a retimed picture", thrown);  // the stream gets its next one
    }
    finish(structure->stream);
  }
}

// Waits for the next tick; empty when the loop stops.
std::optional<RetimeSchedule::Tick> RetimeLoop::take() {
  std::unique_lock lock(mutex_);
  std::optional<RetimeSchedule::Tick> tick;
  changed_.wait(lock, [&] {
    if (!stop_.stop_requested()) tick = schedule_.take();
    return stop_.stop_requested() || tick;
  });
  return tick;
}

void RetimeLoop::finish(const std::string& stream) {
  std::optional<AtlasJob> served;  // let go after the lock: with it a stream's memory may go
  std::lock_guard lock(mutex_);
  served = schedule_.finish(stream);
}

}  // namespace viewloom
