// SPDX-License-Identifier: Apache-2.0
#include "rpc/wanted_message.h"

#include <utility>

#include "messages/wire_message.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom {

bool WantedMessage::note(FrameOutcome outcome, int64_t now_ns) {
  if (outcome == FrameOutcome::kRefused) return false;
  return used_rate_.note(outcome != FrameOutcome::kReplaced, now_ns);
}

bool WantedMessage::refresh(const std::vector<AtlasPtr>& atlases, uint32_t display_count) {
  if ((display_count == 0) != (display_count_ == 0)) used_rate_.reset();
  display_count_ = display_count;
  v1::PublishFramesResponse response;
  *response.mutable_wanted() = wants_.wanted(atlases, display_count);
  response.mutable_wanted()->set_rate_hz(used_rate_.limitHz());
  std::string serialised = response.SerializeAsString();
  if (serialised == serialised_) return false;
  serialised_ = std::move(serialised);
  message_ = bytesFromMessage(response);
  return true;
}

std::optional<grpc::ByteBuffer> WantedMessage::take() {
  return std::exchange(message_, std::nullopt);
}

}  // namespace viewloom
