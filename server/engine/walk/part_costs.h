// SPDX-License-Identifier: Apache-2.0
// How long rays take on a device, by the kind of kernel.
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "base/cost_estimate.h"

namespace viewloom {

// Kinds of rays: walked through one structure, through several, and through a lens; reflected;
// gathered in the second stage of a lens. Others count something else: answers of several
// structures that are merged apart from their walks, px of samples that are settled, and texels of
// means of colour.
enum class RayKind : uint8_t {
  kWalked,
  kMerged,
  kThroughLens,
  kReflected,
  kGathered,
  kAnswers,
  kSettled,
  kMeans
};

// Thread-safety: as CostEstimate.
class PartCosts {
 public:
  // A ray is taken to cost that much until something was measured, and whatever else is counted
  // that much.
  PartCosts(double start_ns_per_ray, double start_ns_of_others)
      : estimates_(
            all(start_ns_per_ray, start_ns_of_others, std::make_index_sequence<kKindCount>())) {}

  CostEstimate& operator[](RayKind kind) { return estimates_[size_t(kind)]; }

 private:
  static constexpr size_t kKindCount = size_t(RayKind::kMeans) + 1;

  // Reflected rays are counted as if all px were rough.
  static double startOf(RayKind kind, double ray_ns, double other_ns) {
    constexpr double kReflectedShare = 0.25;
    if (kind == RayKind::kReflected) return kReflectedShare * ray_ns;
    return kind < RayKind::kAnswers ? ray_ns : other_ns;
  }

  template <size_t... kKinds>
  static std::array<CostEstimate, kKindCount> all(double ray_ns, double other_ns,
                                                  std::index_sequence<kKinds...>) {
    return {CostEstimate(startOf(RayKind(kKinds), ray_ns, other_ns))...};
  }

  std::array<CostEstimate, kKindCount> estimates_;
};

}  // namespace viewloom
