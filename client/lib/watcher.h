// SPDX-License-Identifier: Apache-2.0
// Watches one stream on one display: whole atlases, through broken connections, and the clock of
// the server.
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

// Called from the watcher's thread, one at a time. They must not destroy the watcher; while one
// runs, nothing is read, and the server skips what comes meanwhile.
struct WatcherCallbacks {
  std::function<void(const v1::AtlasLayout&)> on_layout;
  std::function<void(Atlas)> on_atlas;
  OnConnection on_connection;
  // Every message as it came, before anything is made of it.
  std::function<void(const v1::StreamAtlasesResponse&)> on_message;
};

struct WatcherCounts {
  AtlasCounts atlases;
  uint64_t received_bytes = 0;
  uint64_t reconnects = 0;
};

// After a broken connection it opens the display again, as last changed, waits for its stream, and
// asks for as many atlases as are left of the count. A server that sends heartbeats and falls
// silent for 5 s is a broken connection. Thread-safety: all methods may be called from any thread,
// but the destructor from one only.
class Watcher {
 public:
  Watcher(std::shared_ptr<grpc::Channel> channel, v1::OpenDisplay open, WatcherCallbacks callbacks,
          const BackoffOptions& backoff = {});
  ~Watcher();
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  // Another display, another encoding, or both; also for calls after a broken connection.
  void change(const v1::ChangeDisplay& change);
  // Where the eyes before a tracked stereo display are now; also for calls after a broken
  // connection, while the display stays tracked. The newest count: of poses that come faster than
  // atlases, the server drops those overtaken. One that the server refuses ends the call.
  void sendEyePoses(const v1::EyePoses& poses);
  // Asks the server what time it is; lost when there is no connection. See ClockFollower.
  void probeClock();
  // What the answers of this connection say. None before the first.
  std::optional<ClockOffset> serverClock() const;
  // Tells what was shown when, by the clock of the eye poses. Lost when there is no connection.
  void reportPresented(uint64_t sequence, int64_t presented_time_ns);
  // Breaks off. Does not wait.
  void stop();
  // How it ended: OK when all atlases asked for have come, CANCELLED after stop().
  std::optional<absl::Status> ended() const;
  // Waits for the end, at most so long. True = it has ended.
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
  AtlasAssembler assembler_;  // the thread's own

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  v1::OpenDisplay open_;  // with the count that is left
  std::optional<v1::EyePoses> eyes_;
  bool is_complete_ = false;    // the last atlas asked for has come
  bool was_connected_ = false;  // in this call
  WatcherCounts counts_;
  ServerClock server_clock_;
  std::optional<absl::Status> ended_;

  std::mutex write_mutex_;  // gRPC takes one write at a time; held while one waits for the network
  Call* call_ = nullptr;    // null = no call; guarded by write_mutex_

  std::jthread thread_;  // last: joins before what it uses goes
};

// Asks the server again and again what time it is: quickly at first, so that the clock is known at
// once, then once a second, since clocks drift.
// Thread-safety: none; the watcher outlives it.
class ClockFollower {
 public:
  explicit ClockFollower(Watcher& watcher)
      : thread_([&watcher](const std::stop_token& stop) { run(watcher, stop); }) {}
  // Stop the watcher first: a probe may wait for a network that is not there.
  ~ClockFollower() = default;

 private:
  static void run(Watcher& watcher, const std::stop_token& stop);

  std::jthread thread_;
};

}  // namespace viewloom
