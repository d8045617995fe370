// SPDX-License-Identifier: Apache-2.0
// References between the atlases of one display whose video is chained.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>

#include "display/video_stack.h"
#include "encode/video_chain.h"

namespace viewloom {

// Each atlas refers to the one before, unless that was not completed, or a reader waits for one
// that needs no other. Such atlases are large: all readers together get one every kApart_ns at
// most.
// Times are monotonic. Thread-safety: all methods may be called from any thread.
class AtlasChain {
 public:
  static constexpr int64_t kApart_ns = 200'000'000;

  // For readers. What comes refers to atlases that this one has not got. Nothing happens where the
  // newest that has begun needs no other.
  void want();
  // The same of one that joins: also where frames stand, an atlas is to be made at once, unless the
  // last one that needs no other is too new.
  void wantAtOnce();

  // To be called a few times a second. True when somebody waits and no frame comes: the newest
  // atlas is to be made again.
  bool wantsAgain(int64_t now_ns);
  // The newest atlas is to be made again, and has not begun yet.
  bool isDue() const;

  // Order of the pictures of the next atlas, with which the fewest bytes are coded.
  PictureOrder nextOrder() const;
  // For the encoder, one atlas after the other. Sequence of the atlas that this one refers to;
  // 0 = it needs no other.
  uint64_t begin(uint64_t sequence, int64_t now_ns, PictureOrder order = PictureOrder::kForward);
  void noteWhole(uint64_t sequence);
  const std::shared_ptr<VideoChain>& coder() const { return coder_; }

 private:
  static constexpr int64_t kNever_ns = std::numeric_limits<int64_t>::min();

  // With the lock.
  bool isApart(int64_t now_ns) const;
  bool comesAlone() const { return begun_sequence_ != 0 && begun_sequence_ == alone_sequence_; }

  const std::shared_ptr<VideoChain> coder_ = std::make_shared<VideoChain>();
  mutable std::mutex mutex_;  // guards what follows
  bool is_wanted_ = false;
  bool is_due_ = false;
  uint64_t begun_sequence_ = 0;  // 0 = none yet
  uint64_t whole_sequence_ = 0;  // likewise
  int64_t begun_ns_ = kNever_ns;
  PictureOrder next_order_ = PictureOrder::kForward;
  uint64_t alone_sequence_ = 0;  // the last one that needs no other
  int64_t alone_ns_ = kNever_ns;
  bool was_apart_ = true;  // isApart(), when it was last asked
};

}  // namespace viewloom
