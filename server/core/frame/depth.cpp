// SPDX-License-Identifier: Apache-2.0
#include "frame/depth.h"

#include <cmath>

#include <glm/gtc/packing.hpp>

#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr double kU16Max = 65535;
// Scales and offsets beyond these leave binary32, in which kernels compute.
constexpr double kScaleMin = 1e-30;
constexpr double kScaleMax = 1e30;

// kWindow bounds are binary32 in OpenXR; a sample of the far plane equals the rounded bound.
double asBinary32(double value) {
  return static_cast<double>(static_cast<float>(value));
}

// The invalid value as a sample of this encoding can hold it.
float storedInvalidValue(double value, PlaneEncoding encoding) {
  const float rounded = static_cast<float>(value);
  return encoding == PlaneEncoding::kDepthF16 ? glm::unpackHalf1x16(glm::packHalf1x16(rounded))
                                              : rounded;
}

// Window depth is linear in 1/Z between (min_depth, 1/near) and (max_depth, 1/far).
struct WindowLine {
  double origin;  // the end with the smaller 1/Z
  double slope;
  double inv_z_at_origin;
};

WindowLine windowLine(const DepthFormat& format) {
  const double min_depth = asBinary32(format.min_depth);
  const double max_depth = asBinary32(format.max_depth);
  const double inv_near = 1 / format.near_z_m;
  const double inv_far = 1 / format.far_z_m;
  const bool reversed = inv_near < inv_far;
  return {.origin = reversed ? min_depth : max_depth,
          .slope = (inv_far - inv_near) / (max_depth - min_depth),
          .inv_z_at_origin = reversed ? inv_near : inv_far};
}

absl::Status validateWindow(const DepthFormat& format, std::string_view field) {
  const auto outside = [](double depth) { return !(depth >= 0 && depth <= 1); };
  if (outside(format.min_depth)) {
    return invalidField(strCat(field, ".min_depth"),
                        strCat("got ", format.min_depth, "; accepted is 0..1"));
  }
  if (outside(format.max_depth) || asBinary32(format.max_depth) <= asBinary32(format.min_depth)) {
    return invalidField(strCat(field, ".max_depth"),
                        strCat("got ", format.max_depth, "; accepted is more than min_depth (",
                               format.min_depth, "), up to 1"));
  }
  const auto too_near = [](double z_m) { return !(z_m * double{kInvZMax} >= 1); };
  if (too_near(format.near_z_m)) {
    return invalidField(strCat(field, ".near_z_m"),
                        strCat("the near plane is at ", format.near_z_m,
                               " m; accepted is more than 0, up to infinity"));
  }
  if (too_near(format.far_z_m) || format.far_z_m == format.near_z_m) {
    return invalidField(strCat(field, ".far_z_m"),
                        strCat("the far plane is at ", format.far_z_m,
                               " m; accepted is more than 0, up to infinity, and not near_z_m (",
                               format.near_z_m, " m)"));
  }
  return absl::OkStatus();
}

absl::Status validateScale(const DepthFormat& format, std::string_view field) {
  const double magnitude = std::abs(format.scale);
  if (!(magnitude >= kScaleMin && magnitude <= kScaleMax)) {
    return invalidField(strCat(field, ".scale"),
                        strCat("the scale of the depth is ", format.scale, "; accepted is ",
                               kScaleMin, "..", kScaleMax, " in size, of either sign"));
  }
  if (!(std::abs(format.offset) <= kScaleMax)) {
    return invalidField(strCat(field, ".offset"),
                        strCat("the offset of the depth is ", format.offset, "; accepted is up to ",
                               kScaleMax, " in size"));
  }
  return absl::OkStatus();
}

absl::Status validateInvalidValue(const DepthFormat& format, PlaneEncoding encoding,
                                  std::string_view field) {
  if (!format.invalid_value.has_value()) {
    if (!format.invalid_is_far) return absl::OkStatus();
    return invalidField(
        strCat(field, ".invalid_is_far"),
        "invalid_is_far is set without invalid_value; give the value that means invalid");
  }
  const double value = *format.invalid_value;
  const bool storable_u16 = value >= 0 && value <= kU16Max && std::trunc(value) == value;
  if (encoding == PlaneEncoding::kDepthU16 ? !storable_u16 : std::isnan(value)) {
    return invalidField(
        strCat(field, ".invalid_value"),
        strCat("the invalid value is ", value, ", which no sample can have; accepted is ",
               encoding == PlaneEncoding::kDepthU16 ? "a whole number 0..65535" : "any number"));
  }
  return absl::OkStatus();
}

}  // namespace

DepthCoefficients makeDepthCoefficients(const DepthFormat& format, PlaneEncoding encoding) {
  DepthCoefficients coefficients;
  if (format.meaning == DepthMeaning::kWindow) {
    const WindowLine line = windowLine(format);
    const double sample_per_depth = encoding == PlaneEncoding::kDepthU16 ? kU16Max : 1;
    coefficients.origin = static_cast<float>(line.origin * sample_per_depth);
    coefficients.scale = static_cast<float>(line.slope / sample_per_depth);
    coefficients.offset = static_cast<float>(line.inv_z_at_origin);
  } else {
    coefficients.scale = static_cast<float>(format.scale);
    coefficients.offset = static_cast<float>(format.offset) + 0.0F;  // never -0: nor is any value
  }
  coefficients.ray_distance = format.meaning == DepthMeaning::kRayDistance;
  coefficients.reciprocal = coefficients.ray_distance || format.meaning == DepthMeaning::kPlanar;
  coefficients.has_invalid = format.invalid_value.has_value();
  coefficients.invalid_is_far = format.invalid_is_far;
  if (format.invalid_value) {
    coefficients.invalid_value = storedInvalidValue(*format.invalid_value, encoding);
  }
  return coefficients;
}

glm::vec3 surfaceStep(const PlaneFormat& depth) {
  constexpr float kRelativeStepF16 = 0x1p-10F;
  constexpr float kRelativeStepF32 = 0x1p-22F;  // an ulp, and one of the division
  const DepthCoefficients coefficients = makeDepthCoefficients(depth.depth, depth.encoding);
  if (depth.encoding == PlaneEncoding::kDepthU16) {
    const float step = std::abs(coefficients.scale);
    return coefficients.reciprocal != 0 ? glm::vec3(0, 0, step) : glm::vec3(step, 0, 0);
  }
  const bool is_half = depth.encoding == PlaneEncoding::kDepthF16;
  return {0, is_half ? kRelativeStepF16 : kRelativeStepF32, 0};
}

absl::Status validateDepthFormat(const DepthFormat& format, PlaneEncoding encoding,
                                 std::string_view field) {
  VIEWLOOM_RETURN_IF_ERROR(validateInvalidValue(format, encoding, field));
  return format.meaning == DepthMeaning::kWindow ? validateWindow(format, field)
                                                 : validateScale(format, field);
}

}  // namespace viewloom
