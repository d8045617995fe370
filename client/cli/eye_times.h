// SPDX-License-Identifier: Apache-2.0
// When eye poses came, by this process's clock: trackers have clocks of their own.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <optional>

namespace viewloom::cli {

// Thread-safety: all methods may be called from any thread.
class EyeTimes {
 public:
  void note(int64_t time_ns, int64_t here_ns) {
    std::lock_guard lock(mutex_);
    newest_ = (newest_ + 1) % last_.size();
    last_[newest_] = {.time_ns = time_ns, .here_ns = here_ns};
  }

  // Arrival of the newest poses with that time. None if they never came, or came long ago.
  std::optional<int64_t> hereNs(int64_t time_ns) const {
    std::lock_guard lock(mutex_);
    for (size_t age = 0; age < last_.size(); ++age) {
      const Noted& noted = last_[(newest_ + last_.size() - age) % last_.size()];
      if (noted.here_ns != 0 && noted.time_ns == time_ns) return noted.here_ns;
    }
    return std::nullopt;
  }

 private:
  struct Noted {
    int64_t time_ns = 0;
    int64_t here_ns = 0;  // 0 = none
  };

  mutable std::mutex mutex_;
  std::array<Noted, 1024> last_;  // of a tenth of a second at 10 kHz
  size_t newest_ = 0;
};

}  // namespace viewloom::cli
