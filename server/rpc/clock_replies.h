// SPDX-License-Identifier: Apache-2.0
// Replies to clients that ask for the server's time: one slot, in which a newer probe replaces the
// one before.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include <grpcpp/support/byte_buffer.h>

#include "messages/wire_message.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom {

// All times in nanoseconds: the client's of its own clock, the server's of its monotonic one.
// Thread-safety: none.
class ClockReplies {
 public:
  void note(int64_t client_time_ns, int64_t received_ns) {
    waiting_ = Probe{.client_time_ns = client_time_ns, .received_ns = received_ns};
  }
  // A StreamAtlasesResponse; none when nobody asks.
  std::optional<grpc::ByteBuffer> take(int64_t now_ns) {
    const std::optional<Probe> probe = std::exchange(waiting_, std::nullopt);
    if (!probe) return std::nullopt;
    v1::StreamAtlasesResponse response;
    v1::ClockReply& reply = *response.mutable_clock_reply();
    reply.set_client_time_ns(probe->client_time_ns);
    reply.set_server_received_ns(probe->received_ns);
    reply.set_server_sent_ns(now_ns);
    return bytesFromMessage(response);
  }

 private:
  struct Probe {
    int64_t client_time_ns = 0;
    int64_t received_ns = 0;
  };

  std::optional<Probe> waiting_;
};

}  // namespace viewloom
