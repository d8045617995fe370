// SPDX-License-Identifier: Apache-2.0
// What every connection of the web server shares.
#pragma once

#include <atomic>

#include "base/clock.h"
#include "metrics/metrics.h"
#include "publish/broadcaster.h"
#include "publish/stream_directory.h"
#include "web/host_policy.h"
#include "web/http_options.h"

namespace viewloom {

// Outlives all connections. Thread-safety: may be used from any thread.
struct WebContext {
  const HttpOptions options;
  const HostPolicy host_policy;
  const StreamDirectory& streams;
  Broadcaster& broadcaster;
  const Metrics& metrics;
  const Clock& clock;
  std::atomic<bool> draining{false};
};

}  // namespace viewloom
