// SPDX-License-Identifier: Apache-2.0
// Collects durations and says what most of them stayed below.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace viewloom::load {

// Thread-safety: none.
class Percentiles {
 public:
  void add(int64_t sample_ns) { samples_ns_.push_back(sample_ns); }
  void add(const Percentiles& other) {
    samples_ns_.insert(samples_ns_.end(), other.samples_ns_.begin(), other.samples_ns_.end());
  }
  size_t count() const { return samples_ns_.size(); }

  // Milliseconds that `share` of the samples (0..1) do not exceed; 0 without samples.
  double atMs(double share) const {
    if (samples_ns_.empty()) return 0;
    std::vector<int64_t> sorted = samples_ns_;
    const auto rank = static_cast<size_t>(share * static_cast<double>(sorted.size() - 1));
    const auto nth = sorted.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(sorted.begin(), nth, sorted.end());
    return static_cast<double>(*nth) / 1e6;
  }

 private:
  std::vector<int64_t> samples_ns_;
};

}  // namespace viewloom::load
