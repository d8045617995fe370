// SPDX-License-Identifier: Apache-2.0
// Checks of single fields of a display: what came, and what is accepted.
#pragma once

#include <cstdint>
#include <string>

#include "base/status.h"
#include "frame/size.h"

namespace viewloom {

// 1..max.
absl::Status checkCount(uint32_t value, uint32_t max, const std::string& field);
// 1..max a side.
absl::Status checkSize(SizePx size, uint32_t max, const std::string& field);
// NaN fails.
absl::Status checkRange(double value, double min, double max, const std::string& field);
// (0, kViewAngleMax_rad], or 0 for "not given".
absl::Status checkOptionalAngle(double value_rad, const std::string& field);
// kFocalDistanceMin_m..kFocalDistanceMax_m, or 0 for "not given".
absl::Status checkOptionalDistance(double value_m, const std::string& field);

}  // namespace viewloom
