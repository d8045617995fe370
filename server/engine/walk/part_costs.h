// SPDX-License-Identifier: Apache-2.0
// How long rays take on a device, by the kind of kernel.
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "base/cost_estimate.h"

namespace viewloom {

// Kinds of rays: walked through one structure, through several, and through a lens; reflected;
// gathered in the second stage of a lens. Means of colour count texels instead of rays.
enum class RayKind : uint8_t { kWalked, kMerged, kThroughLens, kReflected, kGathered, kMeans };

// Thread-safety: as CostEstimate.
class PartCosts {
 public:
  // A ray is taken to cost that much until something was measured.
  explicit PartCosts(double start_ns_per_ray)
      : estimates_(all(start_ns_per_ray, std::make_index_sequence<kKindCount>())) {}

  CostEstimate& operator[](RayKind kind) { return estimates_[size_t(kind)]; }

 private:
  static constexpr size_t kKindCount = size_t(RayKind::kMeans) + 1;

  template <size_t... kKinds>
  static std::array<CostEstimate, kKindCount> all(double start_ns, std::index_sequence<kKinds...>) {
    return {((void)kKinds, CostEstimate(start_ns))...};
  }

  std::array<CostEstimate, kKindCount> estimates_;
};

}  // namespace viewloom
