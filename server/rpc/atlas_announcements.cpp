// SPDX-License-Identifier: Apache-2.0
#include "rpc/atlas_announcements.h"

#include <utility>

#include "rpc/atlas_messages.h"

namespace viewloom {

std::optional<grpc::ByteBuffer> AtlasAnnouncements::take(const EncodedAtlas& atlas) {
  if (layout_message_.empty() || layout_ != atlas.layout) {
    std::string message = layoutMessage(atlas);
    layout_ = atlas.layout;
    if (message != layout_message_) {
      layout_message_ = std::move(message);
      const grpc::Slice slice(layout_message_);
      return grpc::ByteBuffer(&slice, 1);
    }
  }
  if (skipped_count_ > 0) return skippedMessage(std::exchange(skipped_count_, 0));
  return std::nullopt;
}

}  // namespace viewloom
