// SPDX-License-Identifier: Apache-2.0
#include "rpc/health_watch.h"

#include "messages/wire_message.h"
#include "rpc/status_to_grpc.h"

namespace viewloom {

void HealthWatch::open() {
  std::lock_guard lock(mutex_);
  self_ = shared_from_this();
  is_open_ = true;
  advance();
}

void HealthWatch::drain() {
  using grpc::health::v1::HealthCheckResponse;
  std::lock_guard lock(mutex_);
  if (newest_ != HealthCheckResponse::SERVING) return;
  newest_ = HealthCheckResponse::NOT_SERVING;
  untold_ = newest_;
  advance();
}

void HealthWatch::end(const absl::Status& status) {
  std::lock_guard lock(mutex_);
  if (!end_status_.has_value()) end_status_ = statusToGrpc(status);
  advance();
}

void HealthWatch::OnWriteDone(bool ok) {
  {
    std::lock_guard lock(mutex_);
    outgoing_.Clear();
    is_writing_ = false;
    if (ok) advance();
  }
  if (!ok) OnCancel();
}

void HealthWatch::OnCancel() {
  end(absl::CancelledError("the call was cancelled"));
}

void HealthWatch::OnDone() {
  std::shared_ptr<HealthWatch> self;  // let go after the lock
  std::lock_guard lock(mutex_);
  self = std::move(self_);
}

void HealthWatch::advance() {
  if (!is_open_ || is_writing_ || is_finished_) return;
  if (end_status_.has_value()) {
    is_finished_ = true;
    Finish(*end_status_);
  } else if (untold_.has_value()) {
    grpc::health::v1::HealthCheckResponse response;
    response.set_status(*std::exchange(untold_, std::nullopt));
    outgoing_ = bytesFromMessage(response);
    is_writing_ = true;
    StartWrite(&outgoing_);
  }
}

}  // namespace viewloom
