// SPDX-License-Identifier: Apache-2.0
#include "support/data_sets.h"

#include <cstring>
#include <utility>

#include <Imath/half.h>

#include "absl/strings/str_format.h"
#include "files/plane_file.h"

namespace viewloom::test {
namespace {

absl::StatusOr<std::vector<float>> loadFloats(const v1::PlaneFile& file, SizePx size_px) {
  const absl::StatusOr<files::LoadedPlane> loaded = files::loadDepthPlane(file, {});
  if (!loaded.ok()) return loaded.status();
  if (loaded->plane.size().width() != size_px.width ||
      loaded->plane.size().height() != size_px.height) {
    return invalidField(file.file(), "has not the size of the set");
  }
  const std::vector<uint8_t>& bytes = *loaded->bytes;
  std::vector<float> values(size_px.area());
  if (loaded->plane.encoding() == v1::PLANE_ENCODING_DEPTH_F32) {
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
    return values;
  }
  for (size_t i = 0; i < values.size(); ++i) {
    uint16_t half = 0;
    std::memcpy(&half, &bytes[2 * i], sizeof half);
    values[i] = Imath::half(Imath::half::FromBits, half);
  }
  return values;
}

v1::PlaneFile colorFile(const std::filesystem::path& path,
                        const std::vector<std::string>& channels = {}) {
  v1::PlaneFile file;
  file.set_file(path.string());
  file.mutable_channels()->Add(channels.begin(), channels.end());
  return file;
}

}  // namespace

absl::StatusOr<DataSet> loadBeachBall(const std::filesystem::path& data,
                                      const std::vector<std::string>& channels) {
  // Parallel cameras with focal length x baseline = 333.32 px m, in focus at infinity.
  constexpr double kFocal_px = 2048;
  constexpr double kFocalBaseline_px_m = 333.32;
  const std::filesystem::path path = data / "beachball-stereo" / "singlepart.0001.exr";
  DataSet set = {.name = "beachball",
                 .size_px = {2048, 1556},
                 .focal_px = kFocal_px,
                 .baseline_m = kFocalBaseline_px_m / kFocal_px,
                 .inv_z_in_focus = 0,
                 .color = colorFile(path, channels),
                 .depth = colorFile(path, {"Z"}),
                 .disparity_px = {},
                 .views = {{.name = "left",
                            .columns = -1,
                            .rows = 0,
                            .color = colorFile(path, {"left.R", "left.G", "left.B"})}}};
  v1::DepthFormat& format = *set.depth.mutable_depth();
  format.set_meaning(v1::DEPTH_MEANING_PLANAR);
  format.set_invalid_value(0);  // the black background
  format.set_invalid_is_far(true);
  absl::StatusOr<std::vector<float>> depth_m = loadFloats(set.depth, set.size_px);
  if (!depth_m.ok()) return depth_m.status();
  set.disparity_px = *std::move(depth_m);
  for (float& z : set.disparity_px) z = z == 0 ? 0 : float(kFocalBaseline_px_m / double{z});
  return set;
}

absl::StatusOr<DataSet> loadAntinous(const std::filesystem::path& data) {
  constexpr double kFocal_px = 1462.857;
  constexpr double kFocalBaseline_px_m = 40;
  constexpr double kFocus_m = 8;
  const std::filesystem::path folder = data / "hci-antinous";
  const auto picture = [&](int index) {
    return colorFile(folder / absl::StrFormat("input_Cam%03d.png", index));
  };
  DataSet set = {.name = "antinous",
                 .size_px = {512, 512},
                 .focal_px = kFocal_px,
                 .baseline_m = kFocalBaseline_px_m / kFocal_px,
                 .inv_z_in_focus = 1 / kFocus_m,
                 .color = picture(40),
                 .depth = colorFile(folder / "gt_disp_lowres.pfm"),
                 .disparity_px = {},
                 .views = {}};
  v1::DepthFormat& format = *set.depth.mutable_depth();
  format.set_meaning(v1::DEPTH_MEANING_DISPARITY);
  format.set_scale(1 / kFocalBaseline_px_m);
  format.set_offset(1 / kFocus_m);
  absl::StatusOr<std::vector<float>> disparity_px = loadFloats(set.depth, set.size_px);
  if (!disparity_px.ok()) return disparity_px.status();
  set.disparity_px = *std::move(disparity_px);
  for (int index = 0; index <= 80; ++index) {
    const int columns = index % 9 - 4;
    const int rows = index / 9 - 4;
    const bool is_corner = columns * columns == 16 && rows * rows == 16;
    if (index == 40 || (columns != 0 && rows != 0 && !is_corner)) continue;
    set.views.push_back({.name = absl::StrFormat("%03d", index),
                         .columns = columns,
                         .rows = rows,
                         .color = picture(index)});
  }
  return set;
}

DataSet shifted(DataSet set, double inv_z) {
  set.inv_z_in_focus += inv_z;
  v1::DepthFormat& format = *set.depth.mutable_depth();
  format.set_offset(format.offset() + inv_z);
  return set;
}

Camera sourceCamera(const DataSet& set) {
  return {.pose = {},
          .intrinsics = {{set.focal_px, set.focal_px},
                         {set.size_px.width / 2.0, set.size_px.height / 2.0}}};
}

Camera cameraOf(const DataSet& set, const TrueView& view) {
  Camera camera = sourceCamera(set);
  camera.pose.position_m = {view.columns * set.baseline_m, -view.rows * set.baseline_m, 0};
  const double shift_px = set.focal_px * set.baseline_m * set.inv_z_in_focus;
  camera.intrinsics.principal_px += glm::dvec2(view.columns, view.rows) * shift_px;
  return camera;
}

v1::FrameManifest frameManifest(const DataSet& set) {
  v1::FrameManifest manifest;
  v1::SourceFiles& source = *manifest.add_sources();
  const Intrinsics intrinsics = sourceCamera(set).intrinsics;
  v1::Intrinsics& to = *source.mutable_camera()->mutable_intrinsics();
  to.set_focal_x_px(intrinsics.focal_px.x);
  to.set_focal_y_px(intrinsics.focal_px.y);
  to.set_principal_x_px(intrinsics.principal_px.x);
  to.set_principal_y_px(intrinsics.principal_px.y);
  v1::LayerFiles& layer = *source.add_layers();
  *layer.mutable_color() = set.color;
  *layer.mutable_depth() = set.depth;
  return manifest;
}

}  // namespace viewloom::test
