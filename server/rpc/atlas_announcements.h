// SPDX-License-Identifier: Apache-2.0
// What must be said before an atlas: a new layout, or atlases that were skipped.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <grpcpp/support/byte_buffer.h>

#include "encode/encoded_band.h"

namespace viewloom {

// Thread-safety: none.
class AtlasAnnouncements {
 public:
  // An atlas that the client will not get.
  void noteSkipped() { ++skipped_count_; }
  // The next atlas is of another display: its layout is announced anew.
  void restart() { layout_message_.clear(); }
  // The next message before this atlas; none = it may begin.
  std::optional<grpc::ByteBuffer> take(const EncodedAtlas& atlas);

 private:
  uint64_t skipped_count_ = 0;                 // since the last Skipped message
  std::shared_ptr<const AtlasLayout> layout_;  // the one announced last
  std::string layout_message_;                 // and how; empty = to be announced anew
};

}  // namespace viewloom
