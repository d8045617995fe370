// SPDX-License-Identifier: Apache-2.0
// Somebody who watches in tests, with displays and atlases as small as can be.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "publish/broadcaster.h"

namespace viewloom::test {

inline DisplaySpec quiltOf(uint32_t columns) {
  const auto spec = completeDisplaySpec(
      {.kind = QuiltSpec{.columns = columns, .rows = 2, .size_px = {100, 100}}});
  EXPECT_TRUE(spec.ok()) << spec.status();
  return *spec;
}

inline AtlasPtr atlasOf(uint64_t display_id, uint64_t sequence) {
  EncodedAtlas atlas;
  atlas.display_id = display_id;
  atlas.sequence = sequence;
  return std::make_shared<EncodedAtlas>(atlas);
}

// An atlas whose bands are not packed yet.
inline EncodedAtlas begunAtlas(uint64_t display_id, uint64_t sequence, size_t band_count = 1) {
  EncodedAtlas atlas = *atlasOf(display_id, sequence);
  atlas.bands.resize(band_count);
  return atlas;
}

// Remembers what it was offered and how it ended; notes calls that overlap or come after the end.
class Watcher : public Subscriber {
 public:
  void begin(GrowingAtlasPtr atlas) override {
    const bool overlaps = is_called_.exchange(true);
    std::lock_guard lock(mutex_);
    misused_ |= overlaps || !ends_.empty();
    begun_.push_back(std::move(atlas));
    is_called_ = false;
  }
  void offer(AtlasPtr atlas) override {
    const bool overlaps = is_called_.exchange(true);
    std::lock_guard lock(mutex_);
    misused_ |= overlaps || !ends_.empty();
    sequences_.push_back(atlas->sequence);
    is_called_ = false;
  }
  void end(const absl::Status& status) override {
    const bool overlaps = is_called_.exchange(true);
    std::lock_guard lock(mutex_);
    misused_ |= overlaps;
    ends_.push_back(status);
    is_called_ = false;
  }
  std::vector<uint64_t> sequences() const {
    std::lock_guard lock(mutex_);
    return sequences_;
  }
  std::vector<GrowingAtlasPtr> begun() const {
    std::lock_guard lock(mutex_);
    return begun_;
  }
  std::vector<absl::Status> ends() const {
    std::lock_guard lock(mutex_);
    return ends_;
  }
  bool misused() const {
    std::lock_guard lock(mutex_);
    return misused_;
  }

 private:
  std::atomic<bool> is_called_ = false;
  mutable std::mutex mutex_;
  std::vector<GrowingAtlasPtr> begun_;
  std::vector<uint64_t> sequences_;
  std::vector<absl::Status> ends_;
  bool misused_ = false;
};

using SubscriptionPtr = std::unique_ptr<Broadcaster::Subscription>;

inline SubscriptionPtr join(Broadcaster& broadcaster, const std::string& stream,
                            const DisplaySpec& spec, std::shared_ptr<Subscriber> subscriber,
                            const EncodingSpec& encoding = {}) {
  auto subscription = broadcaster.subscribe(stream, spec, encoding, subscriber);
  EXPECT_TRUE(subscription.ok()) << subscription.status();
  return *std::move(subscription);
}

}  // namespace viewloom::test
