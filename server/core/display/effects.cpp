// SPDX-License-Identifier: Apache-2.0
#include "display/effects.h"

#include <array>

namespace viewloom {
namespace {

constexpr double kDefaultBridge_s = 0.25;

// By quality: draft, balanced, best.
struct LensCounts {
  uint32_t walked;
  uint32_t gathered;
};
constexpr std::array<LensCounts, 3> kLensCounts = {{{4, 16}, {8, 32}, {16, 64}}};
struct ReflectedRays {
  uint32_t bounces;
  uint32_t samples;
};
constexpr std::array<ReflectedRays, 3> kReflectionCounts = {{{1, 2}, {2, 4}, {4, 16}}};

}  // namespace

absl::Status settle(LensSpec& lens, Quality quality) {
  if (lens.has_automatic_aperture && lens.aperture_radius_m != 0) {
    return invalidField("aperture_radius_m",
                        "a radius and automatic_aperture are given; accepted is one of the two");
  }
  if (!lens.has_automatic_aperture && lens.aperture_radius_m == 0) {
    return invalidField("aperture_radius_m",
                        "got 0; accepted is more than 0, up to 10 m, or automatic_aperture");
  }
  const LensCounts& counts = kLensCounts[size_t(quality)];
  if (lens.walked_count == 0) lens.walked_count = counts.walked;
  if (!lens.gathered_count) lens.gathered_count = counts.gathered;
  if (lens.blades == 0) lens.rotation_rad = 0;  // a round opening looks the same however turned
  return absl::OkStatus();
}

void settle(TemporalSpec& temporal) {
  if (temporal.bridge_s == 0) temporal.bridge_s = kDefaultBridge_s;
}

void settle(ReflectionSpec& reflection, Quality quality) {
  const ReflectedRays& counts = kReflectionCounts[size_t(quality)];
  if (reflection.bounce_count == 0) reflection.bounce_count = counts.bounces;
  if (reflection.sample_count == 0) reflection.sample_count = counts.samples;
}

}  // namespace viewloom
