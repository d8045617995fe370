// SPDX-License-Identifier: Apache-2.0
// Options of the web server, and the parts of the server that all its connections share.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "access/access_control.h"
#include "admission/memory_budget.h"
#include "base/clock.h"
#include "eye_poses/eye_track.h"
#include "metrics/metrics.h"
#include "publish/broadcaster.h"
#include "publish/stream_directory.h"
#include "tls/tls_material.h"
#include "video/encoder_choice.h"
#include "web/host_policy.h"
#include "web/message_pace.h"
#include "web/movie_places.h"
#include "web/movie_threads.h"

namespace viewloom {

// How the server listens and what it allows.
struct HttpOptions {
  std::string address = "127.0.0.1";  // numeric, IPv4 or IPv6
  uint16_t port = 0;                  // 0 = any free one
  uint32_t thread_count = 2;
  uint32_t connection_count_max = 1024;
  // Further connections that get /healthz and /metrics, and "too many connections" for the rest.
  uint32_t status_connection_count_max = 16;
  std::vector<std::string> allowed_hosts;    // beside those of HostPolicy
  std::vector<std::string> allowed_origins;  // of pages that may watch
  // Certificate and key of new connections, asked from any thread; none = no encryption.
  std::function<TlsMaterialPtr()> tls{};

  VideoEncoderChoicePtr video_encoders = VideoEncoderChoice::openH264();  // of live videos
  uint32_t movie_count_max = 4;
  uint32_t movie_thread_count = 1;  // that encode them
  uint32_t header_bytes_max = 8192;
  uint32_t message_bytes_max = 128 << 10;  // of a viewer's text message: a calibration fits
  MessageRate message_rate{};              // of a viewer; a flood is read no faster
  std::chrono::milliseconds request_timeout{
      10'000};  // to send a request, from the one before; to shake hands
  std::chrono::milliseconds status_timeout{2'000};     // the same, beyond connection_count_max
  std::chrono::milliseconds idle_timeout{20'000};      // of a viewer that answers no ping
  std::chrono::milliseconds transfer_timeout{60'000};  // to take one reply
  std::chrono::milliseconds still_timeout{10'000};     // until a still's atlas is there
  std::chrono::milliseconds drain_timeout{2'000};      // for viewers to take their leave
};

// Outlives all connections. Thread-safety: may be used from any thread.
struct WebContext {
  const HttpOptions options;
  const HostPolicy host_policy;
  // Whether gRPC clients would get in, for /healthz.
  const std::function<absl::Status()> grpc_health;
  const StreamDirectory& streams;
  Broadcaster& broadcaster;
  EyeSink& eyes;
  const Metrics& metrics;
  const Clock& clock;
  AccessControl& access;
  MemoryBudget& memory;
  FairShares& shares;
  std::atomic<bool> draining{false};
  MoviePlaces movie_places{options.movie_count_max};
  // Last: they use the rest.
  MovieThreads movie_threads{options.movie_thread_count, shares, metrics};
};

}  // namespace viewloom
