// SPDX-License-Identifier: Apache-2.0
// Work shared among all cores.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "base/processor_count.h"

namespace viewloom::bench {

// Calls work(thread, first, last) until 0..count is done, `chunk` at a time, whoever is free next:
// rows are not equally dear.
template <typename Work>
void forChunks(uint32_t count, uint32_t chunk, const Work& work) {
  std::atomic<uint32_t> next{0};
  const auto serve = [&](uint32_t thread) {
    for (;;) {
      const uint32_t first = next.fetch_add(chunk, std::memory_order_relaxed);
      if (first >= count) return;
      work(thread, first, std::min(first + chunk, count));
    }
  };
  std::vector<std::jthread> others;
  for (uint32_t thread = 1; thread < processorCount(); ++thread) others.emplace_back(serve, thread);
  serve(0);
}

}  // namespace viewloom::bench
