// SPDX-License-Identifier: Apache-2.0
#include "inputs/exr_camera.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "absl/strings/numbers.h"
#include "base/str_cat.h"
#include "inputs/axes.h"

namespace viewloom::inputs {
namespace {

// How far axes of a rigid camera may be from unit length and right angles: binary32 and digits.
constexpr double kRigid = 1e-3;
// Share of the larger side: an axis so close to 0, 0 is meant to be in the middle.
constexpr double kMiddle = 0.05;

// Vectors are rows in the file and columns in glm, and so are the 16 numbers.
glm::dmat4 matrixOf(const files::ExrMatrix& numbers) {
  glm::dmat4 matrix;
  for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = numbers[static_cast<size_t>(i)];
  return matrix;
}

bool isFinite(const glm::dmat4& matrix) {
  for (int i = 0; i < 16; ++i) {
    if (!(std::abs(matrix[i / 4][i % 4]) < 1e15)) return false;
  }
  return true;
}

absl::Status refuse(const std::string& file, const std::string& matrix, const std::string& why) {
  return absl::InvalidArgumentError(
      strCat(file, ": header ", matrix, " ", why, "; give the camera by --fov and --input plain"));
}

bool isRigid(const glm::dmat4& matrix) {
  const glm::dmat3 turn(matrix);
  const glm::dmat3 product = turn * glm::transpose(turn);
  for (int i = 0; i < 9; ++i) {
    if (std::abs(product[i / 3][i % 3] - (i % 4 == 0 ? 1 : 0)) > kRigid) return false;
  }
  const glm::dvec4 last(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3] - 1);
  return glm::length(last) <= kRigid;
}

// x_ndc = (x P00 + z P20) / (z P23) and so on, without skew or rotation: what a pinhole's is.
std::optional<v1::Intrinsics> intrinsicsOf(const glm::dmat4& ndc_from_camera, double forward,
                                           const ExrCameraOptions& options) {
  const glm::dmat4& p = ndc_from_camera;
  const double w = p[2][3] * forward;  // per metre ahead
  if (!(w > 1e-9)) return std::nullopt;
  double focal_x = p[0][0] / w, focal_y = -p[1][1] / w;
  double middle_x = p[2][0] * forward / w, middle_y = p[2][1] * forward / w;
  if (std::abs(middle_x) < kMiddle && std::abs(middle_y) < kMiddle) {
    const double up = focal_y < 0 ? 1 : -1;
    focal_x = 0.5 * focal_x;
    middle_x = 0.5 + 0.5 * middle_x;
    focal_y = 0.5 * std::abs(focal_y);
    middle_y = 0.5 - 0.5 * up * middle_y;
  }
  if (!(focal_x > 1e-3 && focal_y > 1e-3 && focal_x < 1e6 && focal_y < 1e6)) return std::nullopt;
  if (!(std::abs(middle_x) < 1e6 && std::abs(middle_y) < 1e6)) return std::nullopt;
  v1::Intrinsics intrinsics;
  intrinsics.set_focal_x_px(focal_x * options.width_px);
  intrinsics.set_focal_y_px(focal_y * options.height_px);
  intrinsics.set_principal_x_px(middle_x * options.width_px);
  intrinsics.set_principal_y_px(middle_y * options.height_px);
  return intrinsics;
}

}  // namespace

absl::StatusOr<std::optional<ExrCamera>> exrCamera(const std::string& file,
                                                   const files::ExrDescription& description,
                                                   const ExrCameraOptions& options) {
  if (!description.world_to_camera) return std::optional<ExrCamera>();
  const glm::dmat4 camera_from_world = matrixOf(*description.world_to_camera);
  if (!isFinite(camera_from_world) || !isRigid(camera_from_world)) {
    return refuse(file, "worldToCamera", "is no turn and shift");
  }
  const double forward = options.looks_along_minus_z ? -1 : 1;
  const glm::dmat4 world_from_camera = glm::inverse(camera_from_world);
  const bool camera_is_left_handed = !options.looks_along_minus_z;
  const bool is_mirrored = glm::determinant(glm::dmat3(camera_from_world)) < 0;
  const bool world_is_left_handed = camera_is_left_handed != is_mirrored;
  const glm::dvec3 to_right_handed(1, 1, world_is_left_handed ? -1 : 1);
  CameraAxes axes;
  axes.right = glm::normalize(to_right_handed * glm::dvec3(world_from_camera[0]));
  axes.up = glm::normalize(to_right_handed * glm::dvec3(world_from_camera[1]));
  axes.position_m = options.metres_per_unit * (to_right_handed * glm::dvec3(world_from_camera[3]));
  ExrCamera camera{.pose = poseOf(axes), .intrinsics = {}};
  if (description.world_to_ndc) {
    const glm::dmat4 ndc_from_world = matrixOf(*description.world_to_ndc);
    if (!isFinite(ndc_from_world)) return refuse(file, "worldToNDC", "is not finite");
    camera.intrinsics = intrinsicsOf(ndc_from_world * world_from_camera, forward, options);
    if (!camera.intrinsics) return refuse(file, "worldToNDC", "is no pinhole's of this camera");
  }
  return std::optional<ExrCamera>(std::move(camera));
}

namespace {

constexpr double kMetresPerCentimetre = 0.01;
constexpr char kPrefix[] = "unreal/camera/";
// Beyond any scene, and far from where squares overflow.
constexpr double kAttributeMax = 1e12;

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
      if (absl::SimpleAtod(text, &value) && std::abs(value) <= kAttributeMax) return value;
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
