// SPDX-License-Identifier: Apache-2.0
#include "publish/atlas_chain.h"

#include <utility>

namespace viewloom {
namespace {

// Without an atlas for so long, frames stand.
constexpr int64_t kChainStands_ns = 250'000'000;

}  // namespace

void AtlasChain::want() {
  std::lock_guard lock(mutex_);
  if (!comesAlone()) is_wanted_ = true;
}

void AtlasChain::wantAtOnce() {
  std::lock_guard lock(mutex_);
  if (comesAlone()) return;
  is_wanted_ = true;
  // Otherwise what is made at once would refer to others, and be of no use.
  is_due_ |= was_apart_;
}

bool AtlasChain::isApart(int64_t now_ns) const {
  return alone_ns_ == kNever_ns || now_ns - alone_ns_ >= kApart_ns;
}

bool AtlasChain::wantsAgain(int64_t now_ns) {
  std::lock_guard lock(mutex_);
  was_apart_ = isApart(now_ns);
  const bool do_stand = begun_ns_ != kNever_ns && now_ns - begun_ns_ >= kChainStands_ns;
  if (!is_wanted_ || !do_stand || !was_apart_) return false;
  is_due_ = true;
  return true;
}

bool AtlasChain::isDue() const {
  std::lock_guard lock(mutex_);
  return is_due_;
}

PictureOrder AtlasChain::nextOrder() const {
  std::lock_guard lock(mutex_);
  return next_order_;
}

uint64_t AtlasChain::begin(uint64_t sequence, int64_t now_ns, PictureOrder order) {
  std::lock_guard lock(mutex_);
  next_order_ = order == PictureOrder::kForward ? PictureOrder::kBackward : PictureOrder::kForward;
  is_due_ = false;
  const bool is_broken = begun_sequence_ != whole_sequence_;
  const uint64_t before = std::exchange(begun_sequence_, sequence);
  begun_ns_ = now_ns;
  was_apart_ = isApart(now_ns);
  const bool refers = before != 0 && !is_broken && !(is_wanted_ && was_apart_);
  if (refers) return before;
  is_wanted_ = was_apart_ = false;
  alone_sequence_ = sequence;
  alone_ns_ = now_ns;
  return 0;
}

void AtlasChain::noteWhole(uint64_t sequence) {
  std::lock_guard lock(mutex_);
  whole_sequence_ = sequence;
}

}  // namespace viewloom
