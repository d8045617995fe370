// SPDX-License-Identifier: Apache-2.0
#include "lib/retry_loop.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

namespace viewloom {

bool isPassing(const absl::Status& status) {
  // UNKNOWN is what gRPC reports when the connection broke in the middle of a call; CANCELLED is
  // what a draining server ends its last calls with.
  return status.code() == absl::StatusCode::kUnavailable ||
         status.code() == absl::StatusCode::kUnknown ||
         status.code() == absl::StatusCode::kCancelled;
}

RetryLoop::RetryLoop(const BackoffOptions& options, OnConnection on_connection,
                     Backoff::Random random, Sleep sleep)
    : backoff_(options, std::move(random)),
      on_connection_(std::move(on_connection)),
      sleep_(std::move(sleep)) {}

absl::Status RetryLoop::run(const std::stop_token& stop, const std::function<CallEnd()>& call) {
  while (true) {
    CallEnd end = call();
    if (stop.stop_requested()) return absl::CancelledError("stopped");
    if (!isPassing(end.status)) return end.status;
    if (end.was_connected) backoff_.reset();
    const int64_t delay_ns = backoff_.nextDelayNs();
    if (on_connection_) {
      on_connection_({ConnectionEvent::Kind::kRetrying, end.status, delay_ns});
    }
    sleep_(stop, delay_ns);
    if (stop.stop_requested()) return absl::CancelledError("stopped");
  }
}

void RetryLoop::sleepUntilStopped(const std::stop_token& stop, int64_t delay_ns) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  never.wait_for(lock, stop, std::chrono::nanoseconds(delay_ns), [] { return false; });
}

}  // namespace viewloom
