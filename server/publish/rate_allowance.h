// SPDX-License-Identifier: Apache-2.0
// Keeps one reader to the bits a second that it wants at most.
#pragma once

#include <algorithm>
#include <cstdint>

namespace viewloom {

// Atlases go out whole, also those that take longer than a second's bits. What is too much then is
// made up for later, so that the rate holds over longer times as well. Times are monotonic.
// Thread-safety: none.
class RateAllowance {
 public:
  // 0 = as many as the line takes.
  explicit RateAllowance(uint64_t bits_per_second_max)
      : bits_per_second_max_(double(bits_per_second_max)) {}

  void note(uint64_t bytes, int64_t now_ns) {
    owed_bits_ = owedBits(now_ns) + 8 * double(bytes);
    noted_ns_ = std::max(noted_ns_, now_ns);
  }
  // Whether an atlas may begin: less than a second's bits are owed.
  bool isOpen(int64_t now_ns) const {
    return bits_per_second_max_ == 0 || owedBits(now_ns) < bits_per_second_max_;
  }

 private:
  double owedBits(int64_t now_ns) const {
    const double seconds = double(std::max<int64_t>(now_ns - noted_ns_, 0)) * 1e-9;
    return std::max(owed_bits_ - seconds * bits_per_second_max_, 0.0);
  }

  const double bits_per_second_max_;
  double owed_bits_ = 0;  // at noted_ns_
  int64_t noted_ns_ = 0;
};

}  // namespace viewloom
