// SPDX-License-Identifier: Apache-2.0
// A client that keeps every atlas, and waits for one by what it shows.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "lib/channel.h"
#include "lib/watcher.h"

namespace viewloom::test {

// Waits fail the test after two minutes, and throw.
// Thread-safety: all methods may be called from any thread.
class AtlasViewer {
 public:
  AtlasViewer(const std::string& address, const v1::OpenDisplay& open)
      : watcher_(makeChannel(address), open,
                 {.on_layout = {},
                  .on_atlas =
                      [this](const Atlas& atlas) {
                        std::lock_guard lock(mutex_);
                        atlases_.push_back(atlas);
                        came_.notify_all();
                      },
                  .on_connection = {}}) {}

  Watcher& watcher() { return watcher_; }

  // The first atlas of which this holds.
  Atlas waitFor(const std::function<bool(const Atlas&)>& holds) {
    std::unique_lock lock(mutex_);
    std::optional<Atlas> found;
    const bool came = came_.wait_for(lock, kPatience, [&] {
      for (const Atlas& atlas : atlases_) {
        if (holds(atlas)) found = atlas;
        if (found) return true;
      }
      return false;
    });
    EXPECT_TRUE(came) << "no such atlas among " << atlases_.size();
    return found.value();
  }
  Atlas waitForFrame(uint64_t number) {
    return waitFor([&](const Atlas& atlas) { return atlas.header.frame_number() == number; });
  }
  Atlas waitForEyes(int64_t time_ns) {
    return waitFor([&](const Atlas& atlas) { return atlas.header.eye_poses_time_ns() == time_ns; });
  }
  // The atlas rendered for these poses.
  Atlas seenBy(const v1::EyePoses& poses) {
    watcher_.sendEyePoses(poses);
    return waitForEyes(poses.time_ns());
  }

 private:
  static constexpr std::chrono::seconds kPatience{120};

  std::mutex mutex_;
  std::condition_variable came_;
  std::vector<Atlas> atlases_;
  Watcher watcher_;  // last: it calls
};

}  // namespace viewloom::test
