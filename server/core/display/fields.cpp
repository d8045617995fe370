// SPDX-License-Identifier: Apache-2.0
#include "display/fields.h"

#include <cmath>
#include <numbers>

#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr uint32_t kColorMax = 0xFFFFFF;
constexpr double kDegPerRad = 180 / std::numbers::pi;

std::string acceptedText(const Range& range) {
  if (range.min == kAnyNumber.min && range.max == kAnyNumber.max) return "a finite number";
  return strCat(range.min, "..", range.max);
}

// Written so that NaN fails.
bool accepts(const Range& range, double value) {
  if (range.accepts_zero && value == 0) return true;
  if (range.accepts_infinity && value > 0 && std::isinf(value)) return true;
  return value >= range.min && value <= range.max;
}

}  // namespace

absl::Status checkRange(double value, const Range& range, const std::string& field) {
  if (accepts(range, value)) return absl::OkStatus();
  // Fields of any finite number have no range to tell.
  if (!field.ends_with("_rad") || std::isinf(range.max * kDegPerRad)) {
    return invalidField(field, strCat("got ", value, "; accepted is ", acceptedText(range)));
  }
  const Range range_deg{range.min * kDegPerRad, range.max * kDegPerRad};
  return invalidField(field,
                      strCat("got ", value, " rad (", value * kDegPerRad, " degrees); accepted is ",
                             acceptedText(range), " rad (", acceptedText(range_deg), " degrees)"));
}

absl::Status checkCount(size_t count, const Range& counts, const std::string& field) {
  if (accepts(counts, double(count))) return absl::OkStatus();
  const std::string some =
      counts.min == counts.max ? strCat(counts.min) : strCat(counts.min, "..", counts.max);
  const bool is_none_apart = counts.accepts_zero && counts.min > 1;
  return invalidField(field, strCat("got ", count, " entries; accepted is ",
                                    is_none_apart ? "none or " : "", some));
}

void FieldChecks::operator()(const char* name, SizePx value, const Range& range) {
  if (value == SizePx{} && !accepts(range, 0)) {
    take(invalidField(prefix_ + name,
                      strCat("missing; accepted is a width and a height of ", acceptedText(range),
                             " px, for example {\"width\": 1024, \"height\": 1024}")));
    return;
  }
  number((std::string(name) + ".width").c_str(), value.width, range);
  number((std::string(name) + ".height").c_str(), value.height, range);
}

void FieldChecks::color(const char* name, uint32_t value) {
  if (value <= kColorMax) return;
  take(invalidField(prefix_ + name, strCat("got 0x", absl::Hex(value), "; accepted is 0..0x",
                                           absl::Hex(kColorMax))));
}

void FieldChecks::cameras(const char* name, const std::vector<ViewCamera>& value,
                          const Range& counts) {
  take(checkCount(value.size(), counts, prefix_ + name));
  for (size_t i = 0; i < value.size() && status_.ok(); ++i) {
    const std::string field = strCat(prefix_, name, "[", i, "]");
    take(validatePose(value[i].pose, field + ".pose"));
    if (const auto* fov = std::get_if<Fov>(&value[i].projection)) {
      take(validateFov(*fov, field + ".fov"));
    } else {
      take(validateIntrinsics(std::get<Intrinsics>(value[i].projection), field + ".intrinsics"));
    }
  }
}

void FieldChecks::pose(const char* name, const std::optional<Pose>& value) {
  if (value) take(validatePose(*value, prefix_ + name));
}

void FieldChecks::number(const char* name, double value, const Range& range) {
  if (status_.ok()) take(checkRange(value, range, prefix_ + name));
}

void FieldChecks::take(const absl::Status& status) {
  if (status_.ok()) status_ = status;
}

}  // namespace viewloom
