// SPDX-License-Identifier: Apache-2.0
#include "lib/backoff.h"

#include <algorithm>
#include <memory>
#include <random>
#include <utility>

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

}  // namespace viewloom
