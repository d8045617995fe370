// SPDX-License-Identifier: Apache-2.0
// A subscriber that keeps every atlas it is offered.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <vector>

#include "publish/subscriber.h"

namespace viewloom::test {

// Thread-safety: all methods may be called from any thread.
class CollectingSubscriber final : public Subscriber {
 public:
  void offer(AtlasPtr atlas) override;
  void end(const absl::Status& status) override;

  // Waits until so many atlases have come; then all that have. Fewer mean that it gave up.
  std::vector<AtlasPtr> waitForAtlases(size_t count);
  // Waits for the end of the display; nullopt means that it gave up.
  std::optional<absl::Status> waitForEnd();

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<AtlasPtr> atlases_;
  std::optional<absl::Status> end_;
};

// Every row of every plane is there exactly once, in order, with bytes.
bool isWhole(const EncodedAtlas& atlas);

}  // namespace viewloom::test
