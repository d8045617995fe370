// SPDX-License-Identifier: Apache-2.0
// How long something has held without a break.
#pragma once

#include <cstdint>
#include <limits>

namespace viewloom {

// Times are monotonic. Thread-safety: none.
class Spell {
 public:
  // Time since it began to hold; 0 where it does not hold now.
  int64_t note(bool holds, int64_t now_ns) {
    if (!holds) begun_ns_ = kNever_ns;
    if (holds && begun_ns_ == kNever_ns) begun_ns_ = now_ns;
    return holds ? now_ns - begun_ns_ : 0;
  }

 private:
  static constexpr int64_t kNever_ns = std::numeric_limits<int64_t>::min();

  int64_t begun_ns_ = kNever_ns;
};

}  // namespace viewloom
