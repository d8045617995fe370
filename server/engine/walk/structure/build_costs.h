// SPDX-License-Identifier: Apache-2.0
// How long passes of a build take on a device, by pass: they differ by far.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "base/cost_estimate.h"

namespace viewloom {

enum class BuildPass : uint8_t {
  kCopy,
  kConvert,
  kPrepare,
  kMeasure,
  kSmooth,
  kFacets,
  kBlocks,
  kLevels,
  kFlatten
};

inline constexpr size_t kBuildPassCount = size_t(BuildPass::kFlatten) + 1;

// Px that passes have taken; of kLevels nodes, of kCopy so many bytes.
class BuiltPx {
 public:
  static constexpr uint64_t kCopiedBytes = 64;

  void add(BuildPass pass, uint64_t px_count) { counts_[size_t(pass)] += px_count; }
  uint64_t of(BuildPass pass) const { return counts_[size_t(pass)]; }
  bool isEmpty() const {
    return std::ranges::all_of(counts_, [](uint64_t count) { return count == 0; });
  }

 private:
  std::array<uint64_t, kBuildPassCount> counts_ = {};
};

// Thread-safety: as CostEstimate.
class BuildCosts {
 public:
  // A px of any pass is taken to cost that much until something was measured; > 0.
  explicit BuildCosts(double start_ns_per_px)
      : estimates_(all(start_ns_per_px, std::make_index_sequence<kBuildPassCount>())) {}

  double nsPerPx(BuildPass pass) const { return estimates_[size_t(pass)].nsPerUnit(); }

  int64_t predictNs(const BuiltPx& px) const {
    int64_t predicted_ns = 0;
    for (size_t pass = 0; pass < kBuildPassCount; ++pass) {
      predicted_ns += estimates_[pass].predictNs(px.of(BuildPass(pass)));
    }
    return predicted_ns;
  }

  // All that together took so long: each pass as much of it as was predicted.
  void note(const BuiltPx& px, int64_t measured_ns) {
    const double share = double(measured_ns) / double(std::max<int64_t>(predictNs(px), 1));
    for (size_t pass = 0; pass < kBuildPassCount; ++pass) {
      const uint64_t count = px.of(BuildPass(pass));
      estimates_[pass].note(count, int64_t(share * double(estimates_[pass].predictNs(count))));
    }
  }

 private:
  template <size_t... kPasses>
  static std::array<CostEstimate, kBuildPassCount> all(double start_ns,
                                                       std::index_sequence<kPasses...>) {
    return {((void)kPasses, CostEstimate(start_ns))...};
  }

  std::array<CostEstimate, kBuildPassCount> estimates_;
};

}  // namespace viewloom
