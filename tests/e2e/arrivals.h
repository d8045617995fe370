// SPDX-License-Identifier: Apache-2.0
// Atlases as they came over a line, for tests of when and how fine they come.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <vector>

namespace viewloom::test {

struct Arrival {
  int64_t at_ns = 0;
  int64_t latency_ns = 0;
  uint64_t bytes = 0;
  uint64_t frame_number = 0;
  uint32_t qp = 0;
  uint32_t rung = 0;
};

// Those from a time on, and before another.
inline std::vector<Arrival> between(const std::vector<Arrival>& all, int64_t from_ns,
                                    int64_t until_ns) {
  std::vector<Arrival> found;
  std::ranges::copy_if(all, std::back_inserter(found), [&](const Arrival& arrival) {
    return arrival.at_ns >= from_ns && arrival.at_ns < until_ns;
  });
  return found;
}

inline int64_t longestGapNs(const std::vector<Arrival>& arrivals) {
  int64_t longest_ns = 0;
  for (size_t i = 1; i < arrivals.size(); ++i) {
    longest_ns = std::max(longest_ns, arrivals[i].at_ns - arrivals[i - 1].at_ns);
  }
  return longest_ns;
}

}  // namespace viewloom::test
