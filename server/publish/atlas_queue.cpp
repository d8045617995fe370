// SPDX-License-Identifier: Apache-2.0
#include "publish/atlas_queue.h"

#include <utility>

#include "base/check.h"

namespace viewloom {

bool AtlasQueue::hasRoom(const EncodedAtlas& atlas) const {
  if (waiting_.size() < kQueuedAtlasesMin) return true;
  return waiting_.size() < kWaitingMax && bytes_ + atlas.byteCount() <= kWaitingBytesMax;
}

size_t AtlasQueue::offer(AtlasPtr atlas, int64_t arrived_ns) {
  size_t missed_count = 0;
  if (atlas->reference_sequence == 0) {
    missed_count = waiting_.size();
    dropWaiting();
    is_stuck_ = false;
  } else if (atlas->reference_sequence != tail_ || !hasRoom(*atlas)) {
    if (tail_ != 0 && !is_stuck_) ++fall_out_count_;
    is_stuck_ = true;
    return tail_ == 0 ? 0 : 1;
  }
  tail_ = atlas->sequence;
  bytes_ += atlas->byteCount();
  waiting_.push_back({std::move(atlas), arrived_ns});
  return missed_count;
}

AtlasQueue::Waiting AtlasQueue::take() {
  VIEWLOOM_CHECK(!waiting_.empty());
  Waiting next = std::move(waiting_.front());
  waiting_.pop_front();
  bytes_ -= next.atlas->byteCount();
  return next;
}

bool AtlasQueue::mayBeNext(const EncodedAtlas& growing) const {
  const bool follows = growing.reference_sequence == 0 || growing.reference_sequence == tail_;
  return waiting_.empty() && follows;
}

void AtlasQueue::noteTaken(const EncodedAtlas& growing) {
  tail_ = growing.sequence;
  is_stuck_ = false;
}

void AtlasQueue::noteLost(uint64_t sequence) {
  if (tail_ == sequence) tail_ = 0;
}

void AtlasQueue::clear() {
  *this = {};
}

void AtlasQueue::dropWaiting() {
  waiting_.clear();
  bytes_ = 0;
}

}  // namespace viewloom
