// SPDX-License-Identifier: Apache-2.0
#include "frame/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/str_cat.h"

namespace viewloom {
namespace {

// How far a quaternion's length may be from 1: what rounding to six digits in a text format leaves.
constexpr double kUnitLengthTolerance = 1e-3;
// Metres from the origin up to which differences of positions still mean something in binary32.
constexpr double kPositionMaxM = 1e9;
// Radians that an angle stays away from +-pi/2, and the smallest opening. Both keep focal lengths
// of images of 1..16384 px inside kFocalMinPx..kFocalMaxPx.
constexpr double kAngleMarginRad = 1e-6;
constexpr double kOpeningMinRad = 1e-6;
// Pixels; the squares of all of them, and of their inverses, are finite in binary32.
constexpr double kFocalMinPx = 1e-7;
constexpr double kFocalMaxPx = 1e11;
constexpr double kPrincipalMaxPx = 1e18;

bool isFinite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

absl::Status validateAngle(double angle_rad, std::string_view field, std::string_view name) {
  if (std::abs(angle_rad) <= std::numbers::pi / 2 - kAngleMarginRad) return absl::OkStatus();
  return invalidField(
      strCat(field, ".", name),
      strCat("the angle is ", angle_rad, " rad; accepted is more than -pi/2 and less than pi/2"));
}

absl::Status validateOpening(double low_rad, double high_rad, std::string_view field,
                             std::string_view low_name, std::string_view high_name) {
  if (high_rad - low_rad >= kOpeningMinRad) return absl::OkStatus();
  return invalidField(strCat(field, ".", high_name),
                      strCat("the angle is ", high_rad, " rad; accepted is more than ", low_name,
                             ", which is ", low_rad));
}

absl::Status validateFocal(double focal_px, std::string_view field, std::string_view name) {
  if (focal_px >= kFocalMinPx && focal_px <= kFocalMaxPx) return absl::OkStatus();
  return invalidField(strCat(field, ".", name),
                      strCat("the focal length is ", focal_px, " px; accepted is ", kFocalMinPx,
                             "..", kFocalMaxPx));
}

absl::Status validatePrincipal(double principal_px, std::string_view field, std::string_view name) {
  if (std::abs(principal_px) <= kPrincipalMaxPx) return absl::OkStatus();
  return invalidField(strCat(field, ".", name),
                      strCat("the principal point is at ", principal_px,
                             " px; accepted is a number up to ", kPrincipalMaxPx, " in size"));
}

}  // namespace

Pose compose(const Pose& outer, const Pose& inner) {
  return {.position_m = outer.position_m + outer.orientation * inner.position_m,
          .orientation = outer.orientation * inner.orientation};
}

Pose inverse(const Pose& pose) {
  const glm::dquat turned_back = glm::conjugate(pose.orientation);
  return {.position_m = -(turned_back * pose.position_m), .orientation = turned_back};
}

Intrinsics intrinsicsFromFov(const Fov& fov, SizePx size_px) {
  const double left = std::tan(fov.left_rad);
  const double right = std::tan(fov.right_rad);
  const double up = std::tan(fov.up_rad);
  const double down = std::tan(fov.down_rad);
  const glm::dvec2 focal_px{size_px.width / (right - left), size_px.height / (up - down)};
  return {.focal_px = focal_px, .principal_px = {-left * focal_px.x, up * focal_px.y}};
}

Fov fovFromIntrinsics(const Intrinsics& intrinsics, SizePx size_px) {
  const glm::dvec2 focal_px = intrinsics.focal_px;
  const glm::dvec2 principal_px = intrinsics.principal_px;
  return {.left_rad = std::atan(-principal_px.x / focal_px.x),
          .right_rad = std::atan((size_px.width - principal_px.x) / focal_px.x),
          .up_rad = std::atan(principal_px.y / focal_px.y),
          .down_rad = std::atan((principal_px.y - size_px.height) / focal_px.y)};
}

absl::Status validatePose(const Pose& pose, std::string_view field) {
  const glm::dvec3& p = pose.position_m;
  if (!isFinite(p) || std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > kPositionMaxM) {
    return invalidField(
        strCat(field, ".position"),
        strCat("the position is (", p.x, ", ", p.y, ", ", p.z, ") m; accepted is up to ",
               kPositionMaxM, " m from 0 along each axis"));
  }
  const double length = glm::length(pose.orientation);
  if (!(std::abs(length - 1) <= kUnitLengthTolerance)) {
    return invalidField(strCat(field, ".orientation"),
                        strCat("the quaternion has length ", length, "; accepted is 1, to within ",
                               kUnitLengthTolerance));
  }
  return absl::OkStatus();
}

absl::Status validateFov(const Fov& fov, std::string_view field) {
  VIEWLOOM_RETURN_IF_ERROR(validateAngle(fov.left_rad, field, "angle_left_rad"));
  VIEWLOOM_RETURN_IF_ERROR(validateAngle(fov.right_rad, field, "angle_right_rad"));
  VIEWLOOM_RETURN_IF_ERROR(validateAngle(fov.up_rad, field, "angle_up_rad"));
  VIEWLOOM_RETURN_IF_ERROR(validateAngle(fov.down_rad, field, "angle_down_rad"));
  VIEWLOOM_RETURN_IF_ERROR(
      validateOpening(fov.left_rad, fov.right_rad, field, "angle_left_rad", "angle_right_rad"));
  return validateOpening(fov.down_rad, fov.up_rad, field, "angle_down_rad", "angle_up_rad");
}

absl::Status validateIntrinsics(const Intrinsics& intrinsics, std::string_view field) {
  VIEWLOOM_RETURN_IF_ERROR(validateFocal(intrinsics.focal_px.x, field, "focal_x_px"));
  VIEWLOOM_RETURN_IF_ERROR(validateFocal(intrinsics.focal_px.y, field, "focal_y_px"));
  VIEWLOOM_RETURN_IF_ERROR(validatePrincipal(intrinsics.principal_px.x, field, "principal_x_px"));
  return validatePrincipal(intrinsics.principal_px.y, field, "principal_y_px");
}

}  // namespace viewloom
