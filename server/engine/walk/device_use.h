// SPDX-License-Identifier: Apache-2.0
// Whether somebody has needed a device lately: work that nobody waits for then has to rest, as a
// piece of it may keep the device for seconds.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "base/thread_time.h"

namespace viewloom {

// Times are of wallTimeNs(). Thread-safety: all methods may be called from any thread.
class DeviceUse {
 public:
  // Other work goes on once nobody has needed the device for so long. Pictures of one viewer are
  // closer together, unless the server is far too slow for them.
  static constexpr int64_t kRest_ns = 2'000'000'000;

  // Somebody needs the device from now on, until end().
  void begin() { ++lasting_count_; }
  void end(int64_t now_ns) {
    note(now_ns);
    --lasting_count_;
  }
  // Somebody needs it, or has needed it until now.
  void note(int64_t now_ns) { last_ns_ = now_ns; }
  // How long other work has to rest before it may ask again, ns; 0 = it may go on.
  int64_t restNs(int64_t now_ns) const {
    if (lasting_count_ > 0) return kRest_ns;
    return std::max<int64_t>(last_ns_ + kRest_ns - now_ns, 0);
  }

 private:
  std::atomic<uint32_t> lasting_count_ = 0;
  std::atomic<int64_t> last_ns_ = -kRest_ns;
};

// Somebody needs the device while this lives. The use outlives it.
class LastingUse {
 public:
  explicit LastingUse(DeviceUse& use) : use_(use) { use_.begin(); }
  LastingUse(const LastingUse&) = delete;
  LastingUse& operator=(const LastingUse&) = delete;
  ~LastingUse() { use_.end(wallTimeNs()); }

 private:
  DeviceUse& use_;
};

}  // namespace viewloom
