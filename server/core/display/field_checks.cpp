// SPDX-License-Identifier: Apache-2.0
#include "display/field_checks.h"

#include "base/str_cat.h"
#include "display/display_kinds.h"

namespace viewloom {

absl::Status checkCount(uint32_t value, uint32_t max, const std::string& field) {
  if (value >= 1 && value <= max) return absl::OkStatus();
  return invalidField(field, strCat("got ", value, ", accepted is 1..", max));
}

absl::Status checkSize(SizePx size, uint32_t max, const std::string& field) {
  VIEWLOOM_RETURN_IF_ERROR(checkCount(size.width, max, strCat(field, ".width")));
  return checkCount(size.height, max, strCat(field, ".height"));
}

// Written so that NaN fails.
absl::Status checkRange(double value, double min, double max, const std::string& field) {
  if (value >= min && value <= max) return absl::OkStatus();
  return invalidField(field, strCat("got ", value, ", accepted is ", min, "..", max));
}

absl::Status checkOptionalAngle(double value_rad, const std::string& field) {
  return checkRange(value_rad, 0, kViewAngleMax_rad, field);
}

absl::Status checkOptionalDistance(double value_m, const std::string& field) {
  if (value_m == 0) return absl::OkStatus();
  return checkRange(value_m, kFocalDistanceMin_m, kFocalDistanceMax_m, field);
}

}  // namespace viewloom
