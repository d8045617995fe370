// SPDX-License-Identifier: Apache-2.0
// Watches one stream on one display. It gives whole atlases, reconnects by itself, and measures the
// server's clock.
#pragma once

#include <grpcpp/channel.h>

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "base/status.h"
#include "lib/atlas_assembler.h"
#include "lib/retry_loop.h"
#include "lib/server_clock.h"
#include "lib/silence_watch.h"
#include "viewloom/v1/display_service.grpc.pb.h"

namespace viewloom {

// Functions that the thread of the watcher calls, one at a time. They must not destroy the watcher.
// While one runs nothing is read, and the server skips atlases.
struct WatcherCallbacks {
  std::function<void(const v1::AtlasLayout&)> on_layout;
  std::function<void(Atlas)> on_atlas;
  OnConnection on_connection;
  // Called for every message as it came, before the other functions.
  std::function<void(const v1::StreamAtlasesResponse&)> on_message;
};

struct WatcherCounts {
  AtlasCounts atlases;
  uint64_t received_bytes = 0;
  uint64_t reconnects = 0;
};

// Watcher of one stream. After a broken connection it opens the display again, as last changed. It
// then waits for its stream, and asks for the atlases that are left of the count. If a server with
// heartbeats is silent for 5 s, the connection counts as broken.
//
// Thread-safety: any thread may call any method, but only one thread the destructor.
class Watcher {
 public:
  Watcher(std::shared_ptr<grpc::Channel> channel, v1::OpenDisplay open, WatcherCallbacks callbacks,
          const BackoffOptions& backoff = {});
  ~Watcher();
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  // Changes the display, the encoding, or both; also for calls after a broken connection.
  void change(const v1::ChangeDisplay& change);
  // Sends the places of the eyes in front of a tracked stereo display. They also count for calls
  // after a broken connection, while the display stays tracked. The server uses the newest poses
  // and drops the others. Poses that the server refuses end the call.
  void sendEyePoses(const v1::EyePoses& poses);
  // Asks for the time of the server. Lost if there is no connection. See ClockFollower.
  void probeClock();
  // Offset by the answers of this connection. Empty before the first.
  std::optional<ClockOffset> serverClock() const;
  // Reports when an atlas was shown, by the clock of the eye poses. Lost if there is no connection.
  void reportPresented(uint64_t sequence, int64_t presented_time_ns);
  // Breaks the call off. Does not wait.
  void stop();
  // Status with which it ended, if it has: OK after the last atlas asked for, CANCELLED after
  // stop().
  std::optional<absl::Status> ended() const;
  // Waits for the end, at most timeout_ns. Returns true if it has ended.
  bool waitEnded(int64_t timeout_ns) const;
  WatcherCounts counts() const;

 private:
  using Call = grpc::ClientReaderWriter<v1::StreamAtlasesRequest, v1::StreamAtlasesResponse>;

  CallEnd runCall(const std::stop_token& stop);
  absl::Status readAtlases(Call& call, SilenceWatch& silence);
  void noteConnected();
  absl::Status deliver(v1::StreamAtlasesResponse message);
  void write(const v1::StreamAtlasesRequest& request);

  const WatcherCallbacks callbacks_;
  const std::unique_ptr<v1::DisplayService::Stub> stub_;
  AtlasAssembler assembler_;  // used by thread_ only

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  v1::OpenDisplay open_;  // with the rest of the count
  std::optional<v1::EyePoses> eyes_;
  bool is_complete_ = false;    // the last atlas has come
  bool was_connected_ = false;  // in this call
  WatcherCounts counts_;
  ServerClock server_clock_;
  std::optional<absl::Status> ended_;

  std::mutex write_mutex_;  // one write at a time; held while a write waits for the network
  Call* call_ = nullptr;    // null = no call; guarded by write_mutex_

  std::jthread thread_;  // last: it uses the members above
};

// Asks for the time of the server repeatedly: quickly at first, then once a second, because clocks
// drift. The watcher must outlive it. Thread-safety: none.
class ClockFollower {
 public:
  explicit ClockFollower(Watcher& watcher)
      : thread_([&watcher](const std::stop_token& stop) { run(watcher, stop); }) {}
  // Stop the watcher first: a probe may wait for the network.
  ~ClockFollower() = default;

 private:
  static void run(Watcher& watcher, const std::stop_token& stop);

  std::jthread thread_;
};

}  // namespace viewloom
