// SPDX-License-Identifier: Apache-2.0
#include "pipeline/retime_loop.h"

#include <algorithm>
#include <utility>

#include "base/thread_name.h"

namespace viewloom {
namespace {

// What is made for one serves the other.
bool showTheSame(const AtlasJob& a, const AtlasJob& b) {
  return a.structure == b.structure && a.before == b.before &&
         a.tick->shown.carried_ns == b.tick->shown.carried_ns;
}

}  // namespace

RetimeLoop::RetimeLoop(const Metrics& metrics, Serve serve)
    : metrics_(metrics), serve_(std::move(serve)) {}

void RetimeLoop::stop() {
  {
    std::lock_guard lock(mutex_);
    is_stopped_ = true;  // no thread is made any more
  }
  changed_.notify_all();
  threads_.clear();
  Streams dropped;  // let go after the lock: their tickets may report
  std::lock_guard lock(mutex_);
  dropped.swap(streams_);
}

bool RetimeLoop::offer(AtlasJob job, const ActiveDisplayPtr& display) {
  std::optional<Tick> replaced;  // let go after the lock: its ticket may report
  {
    std::lock_guard lock(mutex_);
    if (is_stopped_) return false;
    Stream& stream = streams_[job.structure->stream];
    if (stream.in_hand && stream.in_hand->picture_key == job.picture_key) return false;
    const auto older = std::find_if(
        stream.waiting.begin(), stream.waiting.end(),
        [&](const Tick& waiting) { return waiting.job.picture_key == job.picture_key; });
    if (older == stream.waiting.end()) {
      stream.waiting.push_back({std::move(job), display});
    } else {
      if (stream.in_hand && showTheSame(older->job, *stream.in_hand)) return false;
      if (!job.ticket) job.ticket = std::move(older->job.ticket);
      replaced = std::exchange(*older, {std::move(job), display});
      metrics_.output_ticks_skipped.add();
    }
    if (threads_.size() < streams_.size()) {
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
  const auto stream = streams_.find(job.structure->stream);
  if (stream == streams_.end()) return false;
  const auto& [waiting, in_hand] = stream->second;
  return (in_hand && in_hand->picture_key == job.picture_key) ||
         std::any_of(waiting.begin(), waiting.end(),
                     [&](const Tick& tick) { return tick.job.picture_key == job.picture_key; });
}

void RetimeLoop::run() {
  while (std::optional<Tick> tick = take()) {
    const std::string stream = tick->job.structure->stream;
    serve_(std::move(tick->job), tick->display->spec);
    finish(stream);
  }
}

// Waits for a tick of a stream of which none is being served; empty when the loop stops.
std::optional<RetimeLoop::Tick> RetimeLoop::take() {
  std::unique_lock lock(mutex_);
  Streams::iterator found;
  changed_.wait(lock, [&] {
    found = std::find_if(streams_.begin(), streams_.end(), [](const auto& entry) {
      return !entry.second.in_hand && !entry.second.waiting.empty();
    });
    return is_stopped_ || found != streams_.end();
  });
  if (is_stopped_) return std::nullopt;
  Stream& stream = found->second;
  Tick tick = std::move(stream.waiting.front());
  stream.waiting.erase(stream.waiting.begin());
  stream.in_hand = tick.job;
  stream.in_hand->ticket = nullptr;
  return tick;
}

void RetimeLoop::finish(const std::string& name) {
  std::optional<AtlasJob> served;  // let go after the lock: with it a stream's memory may go
  std::lock_guard lock(mutex_);
  Stream& stream = streams_.at(name);
  served.swap(stream.in_hand);
  if (stream.waiting.empty()) streams_.erase(name);
}

}  // namespace viewloom
