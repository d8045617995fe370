// SPDX-License-Identifier: Apache-2.0
#include "rpc/health_watch.h"

#include "messages/wire_message.h"

namespace viewloom {
namespace {

using grpc::health::v1::HealthCheckResponse;

}  // namespace

void HealthWatch::drain() {
  std::lock_guard lock(mutex_);
  is_draining_ = true;
  if (newest_ != HealthCheckResponse::SERVING) return;
  tell(HealthCheckResponse::NOT_SERVING);
  advance();
}

absl::Status HealthWatch::handleRequest(grpc::ByteBuffer& bytes) {
  const absl::StatusOr<Serving> serving = serving_of_(bytes);
  VIEWLOOM_RETURN_IF_ERROR(serving.status());
  std::lock_guard lock(mutex_);
  // A drain that began meanwhile has told nothing yet.
  const bool has_ended = is_draining_ && *serving == HealthCheckResponse::SERVING;
  tell(has_ended ? HealthCheckResponse::NOT_SERVING : *serving);
  advance();
  return absl::OkStatus();
}

void HealthWatch::tell(Serving serving) {
  newest_ = serving;
  is_untold_ = true;
}

std::optional<grpc::ByteBuffer> HealthWatch::takeMessage() {
  if (!std::exchange(is_untold_, false)) return std::nullopt;
  HealthCheckResponse response;
  response.set_status(*newest_);
  return bytesFromMessage(response);
}

}  // namespace viewloom
