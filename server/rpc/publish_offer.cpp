// SPDX-License-Identifier: Apache-2.0
// The way of a publisher's frames into the intake, and the answers that come back.
#include <optional>
#include <utility>

#include <absl/cleanup/cleanup.h>

#include "admission/request_boundary.h"
#include "messages/wire_message.h"
#include "rpc/publish_call.h"
#include "rpc/report_to_proto.h"

namespace viewloom {

void IngestParts::countOutcome(const std::string& stream, FrameOutcome outcome) const {
  directory.countReported(stream, outcome);
  if (outcome == FrameOutcome::kRefused) metrics.frames_refused.add();
}

template <typename Act>
void PublishCall::actOrEnd(const Act& act) {
  const absl::Status status = unlessThrown([&] {
    act();
    return absl::OkStatus();
  });
  if (!status.ok()) end(status);
}

void PublishCall::offerFrame() {
  {
    std::lock_guard lock(mutex_);
    if (ending()) return;
    ++unreported_count_;
    held_back_.noteOffered(last_number_, times_.last_chunk_ns);
    is_offering_ = true;
  }
  const absl::Cleanup offered = [this] { leaveIfEnded(); };
  parts_.directory.countReceived(stream_);
  parts_.metrics.frames_received.add();
  CollectedFrame frame = assembly_->take();
  frame.session = session_;
  frame.publisher = identity_;
  // A frame outlives its call; its outcome is counted all the same.
  parts_.intake.offer(
      stream_, std::move(frame), times_,
      [weak = weak_from_this(), parts = parts_, stream = stream_](const FrameReport& report) {
        parts.countOutcome(stream, report.outcome);
        const auto call = std::static_pointer_cast<PublishCall>(weak.lock());
        if (call) call->actOrEnd([&] { call->onReport(report); });
      },
      [weak = weak_from_this(), number = last_number_] {
        const auto call = std::static_pointer_cast<PublishCall>(weak.lock());
        if (call) call->actOrEnd([&] { call->onTaken(number); });
      });
}

void PublishCall::onTaken(uint64_t number) {
  bool has_new_rate = false;
  {
    std::lock_guard lock(mutex_);
    const int64_t now_ns = parts_.clock.nowNs();
    const std::optional<int64_t> waited_ns = held_back_.noteTaken(number, now_ns);
    if (!waited_ns) return;
    advance();
    has_new_rate = wanted_.noteTurn(*waited_ns, now_ns);
  }
  if (has_new_rate) refreshWanted();
}

void PublishCall::onReport(const FrameReport& report) {
  bool has_new_rate = false;
  {
    std::lock_guard lock(mutex_);
    --unreported_count_;
    v1::PublishFramesResponse response;
    *response.mutable_report() = reportToProto(report);
    replies_.push_back(bytesFromMessage(response));
    advance();
    has_new_rate = wanted_.note(report.outcome, parts_.clock.nowNs());
  }
  if (has_new_rate || report.outcome == FrameOutcome::kTraced) refreshWanted();
}

// While a frame is on its way to the intake, the name stays taken: were the stream forgotten, the
// frame would open it again.
void PublishCall::release() {
  PublishPlace left;
  std::lock_guard lock(mutex_);
  if (!is_offering_) left = std::exchange(place_, {});
}

void PublishCall::leaveIfEnded() {
  PublishPlace left;
  std::lock_guard lock(mutex_);
  is_offering_ = false;
  if (ending()) left = std::exchange(place_, {});
}

}  // namespace viewloom
