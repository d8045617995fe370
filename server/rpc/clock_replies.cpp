// SPDX-License-Identifier: Apache-2.0
#include "rpc/clock_replies.h"

#include <utility>

#include "messages/wire_message.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom {

std::optional<grpc::ByteBuffer> ClockReplies::take(int64_t now_ns) {
  const std::optional<Probe> probe = std::exchange(waiting_, std::nullopt);
  if (!probe) return std::nullopt;
  v1::StreamAtlasesResponse response;
  v1::ClockReply& reply = *response.mutable_clock_reply();
  reply.set_client_time_ns(probe->client_time_ns);
  reply.set_server_received_ns(probe->received_ns);
  reply.set_server_sent_ns(now_ns);
  return bytesFromMessage(response);
}

}  // namespace viewloom
