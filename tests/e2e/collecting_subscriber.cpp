// SPDX-License-Identifier: Apache-2.0
#include "e2e/collecting_subscriber.h"

#include <chrono>
#include <utility>

namespace viewloom::test {
namespace {

constexpr std::chrono::seconds kGiveUpAfter{120};  // reached only by a test that fails

}  // namespace

void CollectingSubscriber::offer(AtlasPtr atlas) {
  std::lock_guard lock(mutex_);
  atlases_.push_back(std::move(atlas));
  changed_.notify_all();
}

void CollectingSubscriber::end(const absl::Status& status) {
  std::lock_guard lock(mutex_);
  end_ = status;
  changed_.notify_all();
}

std::vector<AtlasPtr> CollectingSubscriber::waitForAtlases(size_t count) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, kGiveUpAfter, [&] { return atlases_.size() >= count; });
  return atlases_;
}

std::optional<absl::Status> CollectingSubscriber::waitForEnd() {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, kGiveUpAfter, [&] { return end_.has_value(); });
  return end_;
}

bool isWhole(const EncodedAtlas& atlas) {
  const uint32_t height_px = atlas.layout->size_px.height;
  uint32_t next_row = height_px;
  uint32_t plane_count = 0;
  AtlasPlane plane = AtlasPlane::kColor;
  for (const EncodedBand& band : atlas.bands) {
    if (plane_count == 0 || band.plane != plane) {
      if (next_row != height_px) return false;  // the plane before lacks its end
      plane = band.plane;
      next_row = 0;
      ++plane_count;
    }
    if (band.first_row != next_row || !band.bytes || band.bytes->empty()) return false;
    next_row += band.row_count;
  }
  const uint32_t planes_wanted = 1u + atlas.encoding.with_depth + atlas.encoding.with_mask;
  return plane_count == planes_wanted && next_row == height_px;
}

}  // namespace viewloom::test
