// SPDX-License-Identifier: Apache-2.0
#include "lib/retry_loop.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <random>
#include <utility>

#include "absl/strings/match.h"
#include "base/retry_delay.h"
#include "lib/channel.h"

namespace viewloom {

Backoff::Backoff(const BackoffOptions& options, Random random)
    : options_(options), random_(std::move(random)), mean_ns_(0) {
  reset();
}

int64_t Backoff::nextDelayNs() {
  const double delay_ns = mean_ns_ * (0.5 + random_());
  mean_ns_ = std::min(mean_ns_ * options_.factor, static_cast<double>(options_.max_ns));
  return static_cast<int64_t>(delay_ns);
}

void Backoff::reset() {
  mean_ns_ = static_cast<double>(std::min(options_.first_ns, options_.max_ns));
}

Backoff::Random makeRandom() {
  return [engine = std::mt19937_64(std::random_device{}())]() mutable {
    return std::uniform_real_distribution<double>(0.0, 1.0)(engine);
  };
}

bool isPassing(const absl::Status& status) {
  if (retryDelayNs(status)) return true;
  const bool is_from_transport = isFromTransport(status);
  switch (status.code()) {
    case absl::StatusCode::kUnavailable:
      return true;
    // The connection broke in the middle of a call; a draining server broke off its last calls.
    case absl::StatusCode::kUnknown:
    case absl::StatusCode::kCancelled:
      return !isFromServer(status);
    // RST_STREAM, by a proxy's limits on time or bytes.
    case absl::StatusCode::kInternal:
    case absl::StatusCode::kDeadlineExceeded:
      return is_from_transport;
    // A proxy or gRPC itself is short of something. A message beyond the limit stays too large.
    case absl::StatusCode::kResourceExhausted:
      return is_from_transport && !absl::StrContains(status.message(), "larger than max");
    default:
      return false;
  }
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
    const int64_t delay_ns = retryDelayNs(end.status).value_or(backoff_.nextDelayNs());
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
