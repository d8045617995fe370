// SPDX-License-Identifier: Apache-2.0
// The message that tells a publisher the wishes of its displays, and the rate that is used.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <grpcpp/support/byte_buffer.h>

#include "frame/frame_sink.h"
#include "rpc/source_wants.h"
#include "rpc/used_rate.h"

namespace viewloom {

// Keeps the newest message only. Thread-safety: none.
class WantedMessage {
 public:
  // True if the publisher is to send at another rate.
  bool note(FrameOutcome outcome, int64_t now_ns);
  bool noteTurn(int64_t waited_ns, int64_t now_ns) {
    return used_rate_.noteTurn(waited_ns, now_ns);
  }
  // By the newest atlases of the displays. True if there is a message to be sent.
  bool refresh(const std::vector<AtlasPtr>& atlases, uint32_t display_count);

  bool isDue() const { return message_.has_value(); }
  std::optional<grpc::ByteBuffer> take();

 private:
  SourceWants wants_;
  UsedRate used_rate_;
  uint32_t display_count_ = 0;  // at the last refresh
  std::string serialised_;      // the last message
  std::optional<grpc::ByteBuffer> message_;
};

}  // namespace viewloom
