// SPDX-License-Identifier: Apache-2.0
// Whole atlases that wait for one reader.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "admission/display_price.h"
#include "encode/encoded_band.h"

namespace viewloom {

// An atlas that needs no other replaces all that wait: the newest counts. One that refers to
// another waits behind that. Where it has not got that one, or too much waits, the reader has
// fallen out: it gets no more until an atlas comes that needs no other. Thread-safety: none.
class AtlasQueue {
 public:
  struct Waiting {
    AtlasPtr atlas;
    int64_t arrived_ns = 0;
  };

  // So many bytes wait at most, or two atlases. They are part of the reader's price.
  static constexpr uint64_t kWaitingBytesMax = kQueuedBytesMax;
  // So many atlases wait at most, however small: a reader that decodes too slowly is as far behind.
  static constexpr size_t kWaitingMax = kQueuedAtlasesMax;

  // How many atlases the reader will not get because of this one: those that it replaces, or
  // itself. A reader that has got none yet misses nothing.
  size_t offer(AtlasPtr atlas, int64_t arrived_ns = 0);
  bool isEmpty() const { return waiting_.empty(); }
  // Expects one that waits, as the next.
  const EncodedAtlas& front() const { return *waiting_.front().atlas; }
  Waiting take();

  // Whether this one, which is being made, can be the next.
  bool mayBeNext(const EncodedAtlas& growing) const;
  // It goes to the reader before it is whole.
  void noteTaken(const EncodedAtlas& growing);
  // It was taken, and will not be whole.
  void noteLost(uint64_t sequence);
  void clear();
  // Drops what waits.
  void dropWaiting();

  // An atlas was refused, and none has come since that needs no other.
  bool isStuck() const { return is_stuck_; }
  // Times that the reader has fallen out.
  uint64_t fallOutCount() const { return fall_out_count_; }

 private:
  bool hasRoom(const EncodedAtlas& atlas) const;

  std::deque<Waiting> waiting_;
  uint64_t bytes_ = 0;  // that wait
  uint64_t tail_ = 0;   // sequence of the last one that was kept or taken; 0 = none
  bool is_stuck_ = false;
  uint64_t fall_out_count_ = 0;
};

}  // namespace viewloom
