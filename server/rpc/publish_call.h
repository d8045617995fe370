// SPDX-License-Identifier: Apache-2.0
// One publisher's call: collects its frames, offers them, and tells what became of each.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "admission/frame_price.h"
#include "admission/memory_budget.h"
#include "base/byte_pool.h"
#include "base/clock.h"
#include "base/host_port.h"
#include "decode/frame_intake.h"
#include "frame/limits.h"
#include "metrics/metrics.h"
#include "publish/broadcaster.h"
#include "publish/stream_directory.h"
#include "rpc/bidi_call.h"
#include "rpc/call_access.h"
#include "rpc/held_back.h"
#include "rpc/liveness.h"
#include "rpc/publish_place.h"
#include "rpc/wanted_message.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom {

// Parts of the server that publishing a stream touches. They outlive the calls and the frames that
// came through these.
struct IngestParts {
  FrameIntake& intake;
  BytePool& pool;
  StreamDirectory& directory;
  const Broadcaster& broadcaster;
  const Clock& clock;
  const Metrics& metrics;
  FrameLimits limits;
  MemoryBudget& memory = unboundedMemory();
  PreparedBytes prepared_bytes = [](const FrameFormat&) { return uint64_t{0}; };

  void countOutcome(const std::string& stream, FrameOutcome outcome) const;
};

// However it ends, the stream's name is free at once, and the reports of the frames taken before
// that are still written. Thread-safety: as BidiCall.
class PublishCall final : public BidiCall {
 public:
  // `host`: of the publisher, or the subject of its certificate. Its frames take its share of the
  // memory.
  PublishCall(const IngestParts& parts, Caller caller, std::string host)
      : parts_(parts),
        host_(std::move(host)),
        caller_(std::move(caller)),
        identity_(caller_->shareName(host_)) {}

  // Name of the client whose share it takes (Caller::shareName).
  const std::string& identity() const { return identity_; }
  // Tells the publisher what its displays want now, if that changed.
  void refreshWanted();
  // To be called every kTick: ends the call of a publisher whose heartbeats stay away, or whose
  // identity does not hold any more, and sends heartbeats to it.
  void tick();
  // The stream it publishes; empty before its settings came.
  std::string stream();

 private:
  absl::Status handleMessage(grpc::ByteBuffer& bytes) override;
  absl::Status handleHalfClose() override;
  void release() override;
  void dropReads() override;
  std::optional<grpc::ByteBuffer> takeMessage() override;
  bool wantsToRead() const override;
  bool mayFinish() const override { return unreported_count_ == 0; }

  absl::Status handleChunk(const v1::FrameChunk& chunk);
  absl::Status noteChunk(uint64_t data_bytes);
  absl::Status handleSettings(const v1::PublishSettings& settings);
  absl::Status handleHeader(const v1::FrameHeader& header);
  absl::StatusOr<Reservation> admit(const FrameFormat& format);
  void offerFrame();
  // An exception ends the call.
  template <typename Act>
  void actOrEnd(const Act& act);
  void onReport(const FrameReport& report);
  void onTaken(uint64_t number);
  // A frame was offered: leaves the place if the call has begun to end meanwhile.
  void leaveIfEnded();

  const IngestParts parts_;
  const std::string host_;
  LiveCaller caller_;
  const std::string identity_;

  // Used only by the read callbacks.
  std::optional<FrameAssembly> assembly_;
  FrameTimes times_;
  uint64_t last_number_ = 0;
  uint64_t last_prepared_bytes_ = 0;  // what the last frame took beside its planes
  uint64_t session_ = 0;              // see StreamDirectory::Claim

  // Under mutex_.
  std::string stream_;
  PublishPlace place_;
  std::deque<grpc::ByteBuffer> replies_;  // accepted, then reports
  size_t unreported_count_ = 0;           // frames taken whose report has not come
  HeldBack held_back_;
  bool is_offering_ = false;
  WantedMessage wanted_;
  bool has_heartbeats_ = false;  // the publisher sends them, and gets them
  bool heartbeat_is_due_ = false;
  TicksSince heard_;  // from the publisher
  TicksSince told_;   // to it
};

}  // namespace viewloom
