// SPDX-License-Identifier: Apache-2.0
// The clock that publishers on machines with the same time say as well.
#pragma once

#include <chrono>
#include <cstdint>

namespace viewloom::show {

// Nanoseconds since 1970.
inline int64_t wallTimeNs() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace viewloom::show
