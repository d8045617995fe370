// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
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
  void add(uint32_t value) { absl::StrAppend(&text_, value, " "); }
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
  }
  void add(const StereoSpec& stereo) {
    text_ += "stereo ";
    add(static_cast<uint32_t>(stereo.layout));
    add(stereo.eye_size_px);
    add(stereo.eye_distance_m);
    add(stereo.focal_distance_m);
    add(stereo.fov_y_rad);
    add(stereo.eyes);
  }
  void add(const CamerasSpec& cameras) {
    text_ += "cameras ";
    add(cameras.cameras);
    add(cameras.tile_size_px);
    add(cameras.columns);
    add(static_cast<uint32_t>(cameras.order));
  }
  std::string take() { return std::move(text_); }

 private:
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
  return key.take();
}

std::string encodingKey(const EncodingSpec& encoding) {
  KeyText key;
  key.add(static_cast<uint32_t>(encoding.color));
  if (encoding.color == BandEncoding::kJpeg) {
    key.add(encoding.jpeg_quality);
    key.add(static_cast<uint32_t>(encoding.chroma));
  }
  key.add(static_cast<uint32_t>(encoding.with_depth));
  key.add(static_cast<uint32_t>(encoding.with_mask));
  if (encoding.with_depth || encoding.with_mask) key.add(static_cast<uint32_t>(encoding.planes));
  return key.take();
}

}  // namespace viewloom
