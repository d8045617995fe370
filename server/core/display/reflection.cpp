// SPDX-License-Identifier: Apache-2.0
#include "display/reflection.h"

#include "base/str_cat.h"
#include "display/field_checks.h"

namespace viewloom {
namespace {

// By quality: draft, balanced, best.
struct Counts {
  uint32_t bounces;
  uint32_t samples;
};
constexpr Counts kCounts[] = {{1, 2}, {2, 4}, {4, 16}};

}  // namespace

absl::Status completeReflection(ReflectionSpec& reflection, Quality quality) {
  const Counts& counts = kCounts[size_t(quality)];
  if (reflection.bounce_count == 0) reflection.bounce_count = counts.bounces;
  if (reflection.sample_count == 0) reflection.sample_count = counts.samples;
  VIEWLOOM_RETURN_IF_ERROR(checkCount(reflection.bounce_count, kBounceCountMax, "bounces"));
  VIEWLOOM_RETURN_IF_ERROR(
      checkCount(reflection.sample_count, kReflectionSampleCountMax, "samples"));
  if (reflection.environment_rgb <= 0xFFFFFF) return absl::OkStatus();
  return invalidField("environment_rgb", strCat("got 0x", absl::Hex(reflection.environment_rgb),
                                                ", accepted is 0..0xffffff"));
}

}  // namespace viewloom
