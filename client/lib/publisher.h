// SPDX-License-Identifier: Apache-2.0
// Publishes one stream: newest frame first, through broken connections.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include "base/status.h"
#include "lib/compress_frame.h"
#include "lib/frame_messages.h"
#include "lib/heartbeat_writer.h"
#include "lib/retry_loop.h"
#include "lib/silence_watch.h"
#include "lib/wire_frame.h"
#include "viewloom/v1/ingest_service.grpc.pb.h"

namespace viewloom {

struct PublisherOptions {
  std::string stream;
  std::string session_id;       // empty = random; lets this publisher, and no other, come back
  int zstd_level = 0;           // 0 = planes go as they are
  bool predicts_depth = false;  // as CompressionOptions
  // Frames sent and not yet reported. One is decoded, one built, one traced: more would only be
  // replaced on the server after having been sent.
  size_t in_flight_max = 4;
  BackoffOptions backoff;
};

// Called from the publisher's threads, one at a time per callback. They must not destroy the
// publisher; while one runs, no further answer is read.
struct PublisherCallbacks {
  std::function<void(const v1::PublishAccepted&)> on_accepted;
  std::function<void(const v1::FrameReport&)> on_report;
  std::function<void(const v1::Wanted&)> on_wanted;
  OnConnection on_connection;
  // Each frame whose last byte has gone, as it went; the newest again after a broken connection,
  // under its number.
  std::function<void(const CompressedFrame&)> on_sent;
};

struct PublisherCounts {
  uint64_t offered = 0;
  uint64_t replaced_here = 0;  // overtaken by a newer frame before they were sent
  uint64_t sent = 0;
  uint64_t sent_bytes = 0;
  uint64_t reported = 0;  // by the server, any outcome
  uint64_t replaced_there = 0;
  uint64_t refused = 0;
  uint64_t reconnects = 0;
};

// Frames are numbered 1, 2, ... by the publisher. After a broken connection it comes back with its
// session id, and shows the newest frame again if no newer one waits. It sends heartbeats, and
// takes 5 s without one from the server for a broken connection. While another publisher of this
// host has the stream, it waits for the name. Thread-safety: all methods may be called from any
// thread, but the destructor from one only.
class Publisher {
 public:
  Publisher(std::shared_ptr<grpc::Channel> channel, PublisherOptions options,
            PublisherCallbacks callbacks);
  // Breaks the call off; frames that wait are lost.
  ~Publisher();
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  // Never blocks. The frame takes the place of one that still waits. Its planes are not copied:
  // they are shared, and must not change, until the last of their bytes has gone or the call is
  // over.
  void offer(WireFrame frame);
  // Whether a frame waits to be sent.
  bool isWaiting() const;
  // Sends what waits, and ends the call once all is reported. Nothing may be offered afterwards.
  // Does not wait.
  void close();
  // Closes, and waits for the end. Breaks off with DEADLINE_EXCEEDED after timeout_ns.
  absl::Status finish(int64_t timeout_ns);
  // How the publisher ended, if it has: OK after finish(), else why the server does not take it.
  std::optional<absl::Status> ended() const;
  // Waits for the end, at most so long. True = it has ended.
  bool waitEnded(int64_t timeout_ns) const;
  PublisherCounts counts() const;

 private:
  using Call = HeartbeatWriter::Call;

  CallEnd runCall(const std::stop_token& stop);
  std::unique_ptr<Call> openCall(grpc::ClientContext& context) const;
  void readAnswers(Call& call, SilenceWatch& silence);
  void takeAnswer(const v1::PublishFramesResponse& answer);
  void sendFrames(HeartbeatWriter& writer, const std::stop_token& stop);
  std::optional<WireFrame> waitForFrame(const std::stop_token& stop);
  bool sendFrame(HeartbeatWriter& writer, const WireFrame& frame, const std::stop_token& stop);
  void noteReport(const v1::FrameReport& report);

  const PublisherOptions options_;
  const PublisherCallbacks callbacks_;
  const std::shared_ptr<grpc::Channel> channel_;

  mutable std::mutex mutex_;
  mutable std::condition_variable_any changed_;
  std::optional<WireFrame> waiting_;
  std::optional<WireFrame> newest_sent_;  // shown again after a broken connection
  std::set<uint64_t> in_flight_;          // numbers sent in this call and not reported
  uint64_t last_number_ = 0;
  bool answers_ended_ = false;
  bool was_connected_ = false;  // in this call
  bool finishing_ = false;
  std::optional<absl::Status> ended_;
  PublisherCounts counts_;
  ChunkSize chunk_size_;  // the thread's own

  std::jthread thread_;  // last: joins before what it uses goes
};

}  // namespace viewloom
