// SPDX-License-Identifier: Apache-2.0
#include "inputs/tmiv_camera.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "absl/strings/str_join.h"
#include "base/json_nesting.h"
#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/str_cat.h"
#include "files/file_bytes.h"
#include "files/plane_image.h"
#include "inputs/axes.h"

namespace viewloom::inputs {
namespace {

using Json = nlohmann::json;

constexpr uint64_t kCameraBytesMax = uint64_t{1} << 24;  // thousands of cameras
constexpr double kCameraNumberMax = 1e9;
// A far plane from here on is meant to be infinitely far: 1/Z is then below any step of the codes.
constexpr double kInfinite_m = 1e5;

// One camera of the file; what is missing or of the wrong type is remembered and reported once.
class CameraReader {
 public:
  CameraReader(std::string file, const Json& camera) : file_(std::move(file)), camera_(camera) {}

  const absl::Status& status() const { return status_; }

  double number(const char* key, size_t index) {
    const Json* const list = find(key);
    if (list == nullptr) return 0;
    if (!list->is_array() || index >= list->size()) return refuse(key, "a longer list of numbers");
    return numberOf(key, (*list)[index]);
  }

  double numberOr(const char* key, double otherwise) {
    return camera_.contains(key) ? numberOf(key, camera_[key]) : otherwise;
  }

  std::string textOr(const char* key, const std::string& otherwise) {
    if (!camera_.contains(key)) return otherwise;
    if (camera_[key].is_string()) return camera_[key].get<std::string>();
    refuse(key, "a text");
    return otherwise;
  }

  bool truthOr(const char* key, bool otherwise) {
    if (!camera_.contains(key)) return otherwise;
    const Json& value = camera_[key];
    if (value.is_boolean()) return value.get<bool>();
    return refuse(key, "true or false") != 0;
  }

  // Always 0.
  double refuse(const char* key, const std::string& accepted) {
    if (!status_.ok()) return 0;
    std::string came = camera_.contains(key) ? camera_[key].dump() : "missing";
    if (came.size() > 60) came = came.substr(0, 60) + "...";
    status_ = files::refuseFile(file_, strCat(key, " is ", came, "; accepted is ", accepted));
    return 0;
  }

 private:
  const Json* find(const char* key) {
    if (camera_.contains(key)) return &camera_[key];
    refuse(key, "a list of numbers");
    return nullptr;
  }

  double numberOf(const char* key, const Json& value) {
    if (value.is_string() && value.get<std::string>() == "inf") {
      return std::numeric_limits<double>::infinity();
    }
    if (!value.is_number()) return refuse(key, "a number, or \"inf\"");
    const double number = value.get<double>();
    if (!(std::abs(number) <= kCameraNumberMax)) return refuse(key, "a number up to 1e9");
    return number;
  }

  std::string file_;
  const Json& camera_;
  absl::Status status_;
};

// TMIV's x forward, y left, z up.
glm::dvec3 worldFromTmiv(const glm::dvec3& tmiv) {
  return {-tmiv.y, tmiv.z, -tmiv.x};
}

v1::Pose poseOfCamera(CameraReader& reader) {
  constexpr double kRadPerDeg = std::numbers::pi / 180;
  const auto turn = [&](size_t index, const glm::dvec3& axis) {
    return glm::angleAxis(reader.number("Rotation", index) * kRadPerDeg, axis);
  };
  const glm::dquat rotation = turn(0, {0, 0, 1}) * turn(1, {0, 1, 0}) * turn(2, {1, 0, 0});
  CameraAxes axes;
  axes.position_m = worldFromTmiv(
      {reader.number("Position", 0), reader.number("Position", 1), reader.number("Position", 2)});
  axes.right = worldFromTmiv(rotation * glm::dvec3(0, -1, 0));
  axes.up = worldFromTmiv(rotation * glm::dvec3(0, 0, 1));
  return poseOf(axes);
}

// Normalised disparity: level 0 is the far end, the largest level the near one.
v1::DepthFormat depthFormatOf(CameraReader& reader, uint32_t bits) {
  const double near_m = reader.number("Depth_range", 0);
  const double far_m = reader.number("Depth_range", 1);
  if (!(near_m > 0 && far_m > near_m)) {
    reader.refuse("Depth_range", "[near, far] in metres, 0 < near < far");
    return {};
  }
  const double low = far_m >= kInfinite_m ? 0 : 1 / far_m;
  v1::DepthFormat format;
  format.set_meaning(v1::DEPTH_MEANING_DISPARITY);
  format.set_scale((1 / near_m - low) / (std::exp2(bits) - 1));
  format.set_offset(low);
  if (reader.truthOr("HasInvalidDepth", false)) format.set_invalid_value(0);
  return format;
}

absl::StatusOr<TmivCamera> cameraOf(const std::string& file, const Json& json) {
  CameraReader reader(file, json);
  TmivCamera camera;
  camera.name = reader.textOr("Name", "");
  if (reader.textOr("Projection", "Perspective") != "Perspective") {
    reader.refuse("Projection", "\"Perspective\"; convert other projections first");
  }
  const double width = reader.number("Resolution", 0), height = reader.number("Resolution", 1);
  if (!(width >= 1 && height >= 1 && width <= files::kSideMax_px && height <= files::kSideMax_px)) {
    reader.refuse("Resolution", strCat("[width, height] in px, 1..", files::kSideMax_px));
  }
  const double color_bits = reader.numberOr("BitDepthColor", 10);
  const double depth_bits = reader.numberOr("BitDepthDepth", 16);
  for (const auto& [key, bits] :
       {std::pair{"BitDepthColor", color_bits}, std::pair{"BitDepthDepth", depth_bits}}) {
    if (!(bits >= 8 && bits <= 16)) reader.refuse(key, "8..16");
  }
  if (!reader.status().ok()) return reader.status();
  camera.size.set_width(static_cast<uint32_t>(width));
  camera.size.set_height(static_cast<uint32_t>(height));
  camera.color_bits = static_cast<uint32_t>(color_bits);
  camera.depth_bits = static_cast<uint32_t>(depth_bits);
  camera.color_has_chroma = reader.textOr("ColorSpace", "YUV420") != "YUV400";
  camera.depth_has_chroma = reader.textOr("DepthColorSpace", "YUV420") != "YUV400";
  *camera.camera.mutable_pose() = poseOfCamera(reader);
  v1::Intrinsics& intrinsics = *camera.camera.mutable_intrinsics();
  intrinsics.set_focal_x_px(reader.number("Focal", 0));
  intrinsics.set_focal_y_px(reader.number("Focal", 1));
  intrinsics.set_principal_x_px(reader.number("Principle_point", 0));
  intrinsics.set_principal_y_px(reader.number("Principle_point", 1));
  if (!(intrinsics.focal_x_px() > 0 && intrinsics.focal_y_px() > 0)) {
    reader.refuse("Focal", "[x, y] in px, above 0");
  }
  camera.depth = depthFormatOf(reader, camera.depth_bits);
  if (!reader.status().ok()) return reader.status();
  return camera;
}

// The cameras of a whole file, of one list, or a single one.
std::vector<const Json*> camerasIn(const Json& json) {
  const Json& list = json.is_object() && json.contains("cameras") ? json["cameras"] : json;
  if (list.is_object()) return {&list};
  std::vector<const Json*> cameras;
  for (const Json& camera : list) {
    if (camera.is_object()) cameras.push_back(&camera);
  }
  return cameras;
}

std::string nameIn(const Json& camera) {
  const bool has_name = camera.contains("Name") && camera["Name"].is_string();
  return has_name ? camera["Name"].get<std::string>() : std::string();
}

bool isMeant(const std::string& camera, const std::string& name, const std::string& depth_stem) {
  if (!name.empty()) return camera == name;
  return !camera.empty() && (depth_stem == camera || depth_stem.starts_with(camera + "_"));
}

}  // namespace

absl::StatusOr<TmivCamera> readTmivCamera(const std::filesystem::path& path,
                                          const std::string& name, const std::string& depth_file) {
  const absl::StatusOr<std::vector<uint8_t>> bytes = files::readFileBytes(path, kCameraBytesMax);
  if (!bytes.ok()) return bytes.status();
  if (isNestedDeeply({reinterpret_cast<const char*>(bytes->data()), bytes->size()})) {
    return files::refuseFile(path.string(), strCat("nests lists or objects deeper than ",
                                                   kJsonDepthMax, " levels; accepted is less"));
  }
  const Json json = Json::parse(bytes->begin(), bytes->end(), nullptr, false);
  if (json.is_discarded()) {
    return files::refuseFile(path.string(),
                             "is not JSON; accepted are the camera parameters of TMIV");
  }
  const std::vector<const Json*> cameras = camerasIn(json);
  const std::string depth_stem = std::filesystem::path(depth_file).stem().string();
  std::vector<std::string> known;
  for (const Json* camera : cameras) {
    const std::string its_name = nameIn(*camera);
    if (isMeant(its_name, name, depth_stem)) return cameraOf(path.string(), *camera);
    known.push_back(printable(its_name));
  }
  if (cameras.size() == 1 && name.empty()) return cameraOf(path.string(), *cameras.front());
  const std::string meant = name.empty() ? "" : didYouMean(name, known);
  return files::refuseFile(
      path.string(), strCat("has no camera ", name.empty() ? "for " + depth_file : name,
                            "; it has ", absl::StrJoin(known, ", "),
                            ". Choose one with --camera-name", meant.empty() ? "" : "; ", meant));
}

}  // namespace viewloom::inputs
