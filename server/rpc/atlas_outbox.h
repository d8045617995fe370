// SPDX-License-Identifier: Apache-2.0
// Messages that one call writes about the atlases of its display, in order.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <grpcpp/support/byte_buffer.h>

#include "eye_poses/sent_poses.h"
#include "metrics/metrics.h"
#include "publish/atlas_queue.h"
#include "rpc/atlas_messages.h"

namespace viewloom {

// Announcements before an atlas: a new layout, or skipped atlases. Thread-safety: none.
class AtlasAnnouncements {
 public:
  // So many atlases the client will not get.
  void noteSkipped(uint64_t count) { skipped_count_ += count; }
  // The next atlas is of another display: its layout is announced anew.
  void restart() { layout_message_.clear(); }
  // The next message before this atlas; none = it may begin.
  std::optional<grpc::ByteBuffer> take(const EncodedAtlas& atlas);

 private:
  uint64_t skipped_count_ = 0;                 // since the last Skipped message
  std::shared_ptr<const AtlasLayout> layout_;  // the one announced last
  std::string layout_message_;                 // and how; empty = to be announced anew
};

// One atlas at a time, to its end. The newest whole one is next, or those of chained video in
// order; where none waits, the one that is being made, once its first band is packed. So no client
// gets an atlas later than if it were sent whole, and no more than two atlases are held for one
// that is slow, beside the newest, which is held for all; of chained video, what AtlasQueue holds.
// Thread-safety: none.
class AtlasOutbox {
 public:
  explicit AtlasOutbox(const Metrics& metrics) : metrics_(metrics) {}

  // So many atlases are wanted; 0 = no end.
  void limit(uint32_t count) { count_ = count; }
  // Atlases to come are of another display. The one that is being written is abandoned, unless it
  // is whole. `reader` hears of atlases that have grown.
  void restart(std::shared_ptr<AtlasReader> reader);
  // The same as Subscriber::begin and Subscriber::offer; so many viewers share the atlas.
  void begin(GrowingAtlasPtr atlas, size_t viewer_count);
  void offer(AtlasPtr atlas);
  // Nothing more comes in. The one that is being written is abandoned, unless it is whole; what is
  // whole and waits is still written if the server drains.
  void close(bool is_draining);

  // The next message, if there is one; without may_begin only of the atlas that is being written.
  std::optional<grpc::ByteBuffer> take(bool may_begin);
  // take() has another to give at once.
  bool hasMore() const { return sending_ && sending_->isReady(); }
  // The message that take() gave last was the last one of an atlas.
  bool hasEndedAtlas() const { return has_ended_atlas_; }
  // The client has fallen out of chained video: see AtlasQueue.
  bool isStuck() const { return queue_.isStuck(); }
  uint64_t fallOutCount() const { return queue_.fallOutCount(); }
  // All that are wanted were written.
  bool isThrough() const { return count_ != 0 && sent_count_ == count_; }

  const SentPoses& sentPoses() const { return sent_poses_; }

 private:
  bool mayBegin();
  std::optional<grpc::ByteBuffer> takeBefore(bool may_begin);

  const Metrics& metrics_;
  std::shared_ptr<AtlasReader> reader_;
  uint32_t count_ = 0;
  uint64_t sent_count_ = 0;      // atlases written, or being written, whole
  uint64_t begun_sequence_ = 0;  // of the last that was begun to be written
  AtlasQueue queue_;             // whole ones that wait
  // The newest, unless it is whole or being written.
  std::optional<AtlasMessages> growing_;
  std::optional<AtlasMessages> sending_;
  bool sends_earlier_ = false;  // an atlas of the display before
  AtlasAnnouncements announcements_;
  SentPoses sent_poses_;
  bool has_ended_atlas_ = false;
};

}  // namespace viewloom
