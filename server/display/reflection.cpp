// SPDX-License-Identifier: Apache-2.0
#include "display/reflection.h"

#include "absl/strings/str_cat.h"
#include "display/field_checks.h"

namespace viewloom {

absl::Status complete(ReflectionSpec& reflection) {
  VIEWLOOM_RETURN_IF_ERROR(checkCount(reflection.bounce_count, kBounceCountMax, "bounces"));
  if (reflection.sample_count == 0) reflection.sample_count = kDefaultReflectionSampleCount;
  VIEWLOOM_RETURN_IF_ERROR(
      checkCount(reflection.sample_count, kReflectionSampleCountMax, "samples"));
  if (reflection.environment_rgb <= 0xFFFFFF) return absl::OkStatus();
  return invalidField(
      "environment_rgb",
      absl::StrCat("got 0x", absl::Hex(reflection.environment_rgb), ", accepted is 0..0xffffff"));
}

}  // namespace viewloom
