// SPDX-License-Identifier: Apache-2.0
// Publishes one stream, newest frame first, and reconnects by itself.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include "base/status.h"
#include "lib/color_video.h"
#include "lib/compress_frame.h"
#include "lib/frame_messages.h"
#include "lib/heartbeat_writer.h"
#include "lib/retry_loop.h"
#include "lib/send_pace.h"
#include "lib/silence_watch.h"
#include "lib/wire_frame.h"
#include "viewloom/v1/ingest_service.grpc.pb.h"

namespace viewloom {

class ColorCoder;

struct PublisherOptions {
  std::string stream;
  std::string session_id;       // lets only this publisher come back; empty = random
  int zstd_level = 0;           // 0 = planes are not compressed
  bool predicts_depth = false;  // as in CompressionOptions
  // Colour is sent as video, with small errors. Nothing: it is sent unchanged.
  std::optional<ColorVideo> color_video = {};
  // Most frames that are sent and not yet reported. The server receives one, builds one and renders
  // one at a time. Further ones would only grow old on their way.
  size_t in_flight_max = 4;
  BackoffOptions backoff;
};

// Functions that the threads of the publisher call, each from one thread at a time. They must not
// destroy the publisher. While one runs, no further answer is read.
struct PublisherCallbacks {
  std::function<void(const v1::PublishAccepted&)> on_accepted;
  std::function<void(const v1::FrameReport&)> on_report;
  std::function<void(const v1::Wanted&)> on_wanted;
  OnConnection on_connection;
  // Called for each frame after its last byte was sent. After a broken connection it is called
  // again for the newest frame, with the same number.
  std::function<void(const CompressedFrame&)> on_sent;
};

// Counts of frames. A frame that goes again after a broken connection counts once.
struct PublisherCounts {
  uint64_t offered = 0;
  uint64_t replaced_here = 0;  // replaced by a newer frame before they were sent
  uint64_t sent = 0;           // the server has reported them, and did not refuse them
  uint64_t sent_bytes = 0;     // planes of these, as they went
  uint64_t reported = 0;       // by the server, any outcome
  uint64_t replaced_there = 0;
  uint64_t refused = 0;
  uint64_t reconnects = 0;
};

// Publisher of one stream. It numbers frames 1, 2, ...
//
// It sends frames once the server has accepted the stream. Until then, newer frames replace older
// ones. It sends no more frames a second than the server uses (proto Wanted). A frame waits for its
// time, and a newer one replaces it. The last frame before close() does not wait.
//
// After a broken connection it reconnects with its session id. It sends the newest frame again if
// no newer one waits. It sends heartbeats, and treats 5 s without one from the server as a broken
// connection. While another publisher of this host has the stream, it waits for the name.
//
// Thread-safety: any thread may call any method, but only one thread the destructor.
class Publisher {
 public:
  Publisher(std::shared_ptr<grpc::Channel> channel, PublisherOptions options,
            PublisherCallbacks callbacks);
  // Breaks the call off. Waiting frames are lost.
  ~Publisher();
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  // Offers a frame; never blocks. The frame replaces one that still waits. Its planes are shared,
  // not copied. They must not change until their last byte is sent or the call is over.
  void offer(WireFrame frame);
  // Whether a frame waits to be sent.
  bool isWaiting() const;
  // Sends the waiting frame, and ends the call once all frames are reported. Nothing may be offered
  // afterwards. Does not wait.
  void close();
  // Closes and waits for the end. Breaks off with DEADLINE_EXCEEDED after timeout_ns.
  absl::Status finish(int64_t timeout_ns);
  // Status with which the publisher ended, if it has. OK after finish(), else the server's refusal.
  std::optional<absl::Status> ended() const;
  // Waits for the end, at most timeout_ns. Returns true if it has ended.
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
  void count(const v1::FrameReport& report, uint64_t bytes);
  void noteWanted(const v1::Wanted& wanted);

  const PublisherOptions options_;
  const PublisherCallbacks callbacks_;
  const std::shared_ptr<grpc::Channel> channel_;

  mutable std::mutex mutex_;
  mutable std::condition_variable_any changed_;
  std::optional<WireFrame> waiting_;
  std::optional<WireFrame> newest_sent_;    // sent again after a broken connection
  std::map<uint64_t, uint64_t> in_flight_;  // number to bytes: sent in this call, not reported
  uint64_t last_reported_ = 0;              // greatest number of a report
  uint64_t again_ = 0;  // number that this call sends again after its report; 0 = none
  SendPace pace_;
  uint64_t last_number_ = 0;
  bool answers_ended_ = false;
  bool was_connected_ = false;  // in this call
  bool finishing_ = false;
  std::optional<absl::Status> ended_;
  PublisherCounts counts_;
  ChunkSize chunk_size_;                           // used by thread_ only, as the next
  const std::unique_ptr<ColorCoder> color_coder_;  // null = colour is sent unchanged

  std::jthread thread_;  // last: it uses the members above
};

}  // namespace viewloom
