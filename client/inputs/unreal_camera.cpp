// SPDX-License-Identifier: Apache-2.0
#include "inputs/unreal_camera.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <glm/vec3.hpp>

#include "absl/strings/numbers.h"
#include "base/str_cat.h"
#include "inputs/axes.h"

namespace viewloom::inputs {
namespace {

constexpr double kMetresPerCentimetre = 0.01;
constexpr char kPrefix[] = "unreal/camera/";
// Beyond any scene, and far from where squares overflow.
constexpr double kNumberMax = 1e12;

// Numbers of the header, found by how their names end.
class HeaderNumbers {
 public:
  HeaderNumbers(std::string file, const std::map<std::string, std::string>& texts)
      : file_(std::move(file)), texts_(texts) {}

  // The first attribute below unreal/camera/ that ends so, as "/fov". Nothing when there is none,
  // and when it is no number: then there is a status.
  std::optional<double> find(const std::string& ending) {
    for (const auto& [name, text] : texts_) {
      if (!name.starts_with(kPrefix) || !name.ends_with(ending)) continue;
      double value = 0;
      if (absl::SimpleAtod(text, &value) && std::abs(value) <= kNumberMax) return value;
      if (status_.ok()) {
        status_ = absl::InvalidArgumentError(
            strCat(file_, ": header ", name, " is \"", text.substr(0, 40),
                   "\"; accepted is a number: correct it, or give the camera by --fov and "
                   "--input plain"));
      }
    }
    return std::nullopt;
  }

  const absl::Status& status() const { return status_; }

 private:
  std::string file_;
  const std::map<std::string, std::string>& texts_;
  absl::Status status_;
};

glm::dvec3 worldFromUnreal(const glm::dvec3& unreal) {
  return {unreal.y, unreal.z, -unreal.x};
}

// Yaw turns right, pitch up, roll clockwise as the camera sees it: roll first, yaw last. Rows of
// Unreal's rotation matrix.
CameraAxes axesOf(double pitch_deg, double yaw_deg, double roll_deg) {
  constexpr double kRadPerDeg = std::numbers::pi / 180;
  const double sp = std::sin(pitch_deg * kRadPerDeg), cp = std::cos(pitch_deg * kRadPerDeg);
  const double sy = std::sin(yaw_deg * kRadPerDeg), cy = std::cos(yaw_deg * kRadPerDeg);
  const double sr = std::sin(roll_deg * kRadPerDeg), cr = std::cos(roll_deg * kRadPerDeg);
  CameraAxes axes;
  axes.right = worldFromUnreal({sr * sp * cy - cr * sy, sr * sp * sy + cr * cy, -sr * cp});
  axes.up = worldFromUnreal({-(cr * sp * cy + sr * sy), cy * sr - cr * sp * sy, cr * cp});
  return axes;
}

}  // namespace

absl::StatusOr<std::optional<v1::Camera>> unrealCamera(
    const std::string& file, const std::map<std::string, std::string>& texts, double width_px,
    double height_px, double pixel_aspect) {
  HeaderNumbers numbers(file, texts);
  const auto x = numbers.find("/curPos/x"), y = numbers.find("/curPos/y"),
             z = numbers.find("/curPos/z");
  const auto pitch = numbers.find("/curRot/pitch"), yaw = numbers.find("/curRot/yaw"),
             roll = numbers.find("/curRot/roll");
  const auto focal_mm = numbers.find("/focalLength"), sensor_mm = numbers.find("/sensorWidth");
  std::optional<double> fov_x_deg = numbers.find("/fov");
  if (!numbers.status().ok()) return numbers.status();
  if (!fov_x_deg && focal_mm && sensor_mm && *focal_mm > 0) {
    fov_x_deg = 2 * std::atan(0.5 * *sensor_mm / *focal_mm) * 180 / std::numbers::pi;
  }
  const bool has_place = x && y && z && pitch && yaw && roll;
  if (!has_place && !fov_x_deg) return std::optional<v1::Camera>();
  v1::Camera camera;
  if (has_place) {
    CameraAxes axes = axesOf(*pitch, *yaw, *roll);
    axes.position_m = kMetresPerCentimetre * worldFromUnreal({*x, *y, *z});
    *camera.mutable_pose() = poseOf(axes);
  }
  if (fov_x_deg) {
    if (!(*fov_x_deg > 0.01 && *fov_x_deg < 179)) {
      return absl::InvalidArgumentError(
          strCat(file, ": the header's field of view is ", *fov_x_deg,
                 " degrees; accepted is 0.01..179: give it by --fov and --input plain"));
    }
    *camera.mutable_intrinsics() = intrinsicsAcross(*fov_x_deg, width_px, height_px, pixel_aspect);
  }
  return std::optional<v1::Camera>(std::move(camera));
}

}  // namespace viewloom::inputs
