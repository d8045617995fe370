// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "absl/strings/str_format.h"
#include "base/str_cat.h"
#include "display/display_spec.h"

namespace viewloom {
namespace {

// Every field in a fixed order, each followed by a blank; numbers in hexadecimal, so that none is
// rounded.
class KeyText {
 public:
  void add(double value) {
    absl::StrAppendFormat(&text_, "%a ", value + 0.0);  // -0 becomes 0
  }
  void add(uint32_t value) { text_ += strCat(value, " "); }
  void add(SizePx size) {
    add(size.width);
    add(size.height);
  }
  void add(const Pose& pose) {
    for (int i = 0; i < 3; ++i) add(pose.position_m[i]);
    for (int i = 0; i < 4; ++i) add(pose.orientation[i]);
  }
  void add(const std::vector<ViewCamera>& cameras) {
    add(static_cast<uint32_t>(cameras.size()));
    for (const ViewCamera& camera : cameras) {
      add(camera.pose);
      std::visit([this](const auto& projection) { add(projection); }, camera.projection);
    }
  }
  void add(const QuiltSpec& quilt) {
    text_ += "quilt ";
    add(quilt.columns);
    add(quilt.rows);
    add(quilt.size_px);
    add(quilt.aspect);
    add(quilt.view_cone_rad);
    add(quilt.focal_distance_m);
    add(quilt.fov_y_rad);
    add(static_cast<uint32_t>(quilt.order));
    add(quilt.view_count);
    add(static_cast<uint32_t>(quilt.convention));
    add(quilt.depthiness);
    add(quilt.cone_begin);
    add(quilt.cone_end);
  }
  void add(const StereoSpec& stereo) {
    text_ += "stereo ";
    add(static_cast<uint32_t>(stereo.layout));
    add(stereo.eye_size_px);
    add(stereo.eye_distance_m);
    add(stereo.focal_distance_m);
    add(stereo.fov_y_rad);
    add(stereo.eyes);
    add(static_cast<uint32_t>(stereo.is_tracked));
  }
  void add(const CamerasSpec& cameras) {
    text_ += "cameras ";
    add(cameras.cameras);
    add(cameras.tile_size_px);
    add(cameras.columns);
    add(static_cast<uint32_t>(cameras.order));
    add(static_cast<uint32_t>(cameras.arrangement));
    if (cameras.grid) add(*cameras.grid);
  }
  void add(const LenticularSpec& lenticular) {
    text_ += "lenticular ";
    Calibration calibration = *lenticular.calibration;
    calibration.serial.clear();
    calibration.config_version.clear();
    text_ += strCat(writeCalibration(calibration), " ");
    add(lenticular.view_count);
    add(lenticular.view_cone_rad);
    add(lenticular.focal_distance_m);
    add(lenticular.fov_y_rad);
  }
  void add(const IntegralSpec& integral) {
    text_ += "integral ";
    add(integral.panel_px);
    for (const double length_m :
         {integral.pixel_pitch_m, integral.lens_pitch_m, integral.focal_length_m}) {
      add(length_m);
    }
    add(integral.lens_columns);
    add(integral.lens_rows);
    add(integral.offset_px);
    add(static_cast<uint32_t>(integral.is_flipped));
    add(integral.scale);
    add(integral.distance_m);
  }
  void add(const RgbdSpec& rgbd) {
    text_ += "rgbd ";
    add(rgbd.view_size_px);
    // What a preset gives beyond the form: where the screen is.
    add(static_cast<uint32_t>(!rgbd.preset.empty() && rgbd.screen_m == 0));
    add(static_cast<uint32_t>(*rgbd.form));
    if (rgbd.depth_placement) add(static_cast<uint32_t>(*rgbd.depth_placement));
    add(static_cast<uint32_t>(rgbd.is_black_near));
    for (const double depth_m : {rgbd.near_m, rgbd.far_m, rgbd.screen_m}) add(depth_m);
    add(rgbd.fov_y_rad);
    add(rgbd.depth_bits);
  }
  void add(const LensSpec& lens) {
    text_ += "lens ";
    add(lens.aperture_radius_m);  // 0: automatic
    add(lens.focus_distance_m.value_or(0));
    add(lens.blades);
    if (lens.blades > 0) add(lens.rotation_rad);
    add(lens.walked_count);
    add(*lens.gathered_count);
    add(static_cast<uint32_t>(lens.is_exact));
  }
  void add(const TemporalSpec& temporal) {
    text_ += "temporal ";
    add(temporal.output_rate_hz);
    add(static_cast<uint32_t>(temporal.mode));
    add(temporal.bridge_s);
  }
  void add(const ReflectionSpec& reflection) {
    text_ += "reflection ";
    add(reflection.bounce_count);
    add(reflection.sample_count);
    add(reflection.environment_rgb);
    add(static_cast<uint32_t>(reflection.is_filtered));
  }
  std::string take() { return std::move(text_); }

 private:
  void add(glm::dvec2 pair) {
    add(pair.x);
    add(pair.y);
  }
  void add(const CameraGrid& grid) {
    text_ += "grid ";
    add(grid.columns);
    add(grid.rows);
    add(grid.spacing_m);
    add(grid.focal_distance_m);
    add(grid.fov_y_rad);
  }
  void add(const Fov& fov) {
    text_ += "fov ";
    for (const double angle : {fov.left_rad, fov.right_rad, fov.up_rad, fov.down_rad}) add(angle);
  }
  void add(const Intrinsics& intrinsics) {
    text_ += "px ";
    for (int i = 0; i < 2; ++i) add(intrinsics.focal_px[i]);
    for (int i = 0; i < 2; ++i) add(intrinsics.principal_px[i]);
  }

  std::string text_;
};

}  // namespace

std::string displayKey(const DisplaySpec& spec) {
  KeyText key;
  std::visit([&key](const auto& kind) { key.add(kind); }, spec.kind);
  key.add(static_cast<uint32_t>(spec.world_pose.has_value()));
  if (spec.world_pose) key.add(*spec.world_pose);
  key.add(spec.tolerance_px);
  key.add(static_cast<uint32_t>(spec.outside_fill));
  key.add(spec.background_rgb);
  key.add(spec.focus_following_s);
  key.add(spec.filter.sample_count);
  if (spec.filter.sample_count > 1) key.add(spec.filter.width);
  if (spec.lens) key.add(*spec.lens);
  if (spec.temporal) key.add(*spec.temporal);
  if (spec.reflection) key.add(*spec.reflection);
  return key.take();
}

std::string encodingKey(const EncodingSpec& encoding) {
  KeyText key;
  key.add(static_cast<uint32_t>(encoding.color));
  const bool is_jpeg = encoding.color == BandEncoding::kJpeg;
  if (is_jpeg || encoding.color == BandEncoding::kJpegPlanes) key.add(encoding.jpeg_quality);
  if (is_jpeg) key.add(static_cast<uint32_t>(encoding.chroma));
  key.add(static_cast<uint32_t>(encoding.with_depth));
  key.add(static_cast<uint32_t>(encoding.with_mask));
  key.add(static_cast<uint32_t>(encoding.with_depth_codes));
  if (encoding.with_depth || encoding.with_mask || encoding.with_depth_codes) {
    key.add(static_cast<uint32_t>(encoding.planes));
  }
  return key.take();
}

}  // namespace viewloom
