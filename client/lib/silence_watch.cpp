// SPDX-License-Identifier: Apache-2.0
#include "lib/silence_watch.h"

#include <utility>

#include "base/str_cat.h"
#include "lib/retry_loop.h"

namespace viewloom {

SilenceWatch::SilenceWatch(std::function<void()> on_silence, const SilenceOptions& options)
    : on_silence_(std::move(on_silence)),
      options_(options),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void SilenceWatch::listens() {
  tick_count_ = 0;
  is_listening_ = true;
}

absl::Status SilenceWatch::status() const {
  const auto silence = options_.tick * options_.tick_count_max;
  return absl::UnavailableError(
      strCat("the server has been silent for ",
             std::chrono::duration_cast<std::chrono::seconds>(silence).count(), " s"));
}

void SilenceWatch::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    RetryLoop::sleepUntilStopped(stop, std::chrono::nanoseconds(options_.tick).count());
    if (stop.stop_requested()) return;
    if (!is_listening_ || !has_heartbeats_) continue;
    if (++tick_count_ < options_.tick_count_max) continue;
    has_fired_ = true;
    on_silence_();
    return;
  }
}

}  // namespace viewloom
