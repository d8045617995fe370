// SPDX-License-Identifier: Apache-2.0
#include "messages/display_from_proto.h"

#include <utility>

#include <google/protobuf/repeated_ptr_field.h>

#include "base/str_cat.h"
#include "display/named_display.h"
#include "messages/enum_from_proto.h"
#include "messages/geometry_from_proto.h"
#include "messages/lens_from_proto.h"
#include "messages/temporal_from_proto.h"

namespace viewloom {
namespace {

constexpr EnumRow<v1::TileOrder, TileOrder> kQuiltOrders[] = {
    {v1::TILE_ORDER_UNSPECIFIED, TileOrder::kBottomLeft},
    {v1::TILE_ORDER_BOTTOM_LEFT, TileOrder::kBottomLeft},
    {v1::TILE_ORDER_TOP_LEFT, TileOrder::kTopLeft}};

constexpr EnumRow<v1::TileOrder, TileOrder> kCamerasOrders[] = {
    {v1::TILE_ORDER_UNSPECIFIED, TileOrder::kTopLeft},
    {v1::TILE_ORDER_BOTTOM_LEFT, TileOrder::kBottomLeft},
    {v1::TILE_ORDER_TOP_LEFT, TileOrder::kTopLeft}};

constexpr EnumRow<v1::StereoLayout, StereoLayout> kStereoLayouts[] = {
    {v1::STEREO_LAYOUT_UNSPECIFIED, StereoLayout::kSideBySide},
    {v1::STEREO_LAYOUT_SIDE_BY_SIDE, StereoLayout::kSideBySide},
    {v1::STEREO_LAYOUT_TOP_BOTTOM, StereoLayout::kTopBottom},
    {v1::STEREO_LAYOUT_SEPARATE, StereoLayout::kSeparate}};

constexpr EnumRow<v1::CameraConvention, CameraConvention> kConventions[] = {
    {v1::CAMERA_CONVENTION_UNSPECIFIED, CameraConvention::kWebxr},
    {v1::CAMERA_CONVENTION_WEBXR, CameraConvention::kWebxr},
    {v1::CAMERA_CONVENTION_CORE, CameraConvention::kCore},
    {v1::CAMERA_CONVENTION_BRIDGE, CameraConvention::kBridge}};

constexpr EnumRow<v1::TileArrangement, TileArrangement> kArrangements[] = {
    {v1::TILE_ARRANGEMENT_UNSPECIFIED, TileArrangement::kGrid},
    {v1::TILE_ARRANGEMENT_ATLAS, TileArrangement::kGrid},
    {v1::TILE_ARRANGEMENT_ROW, TileArrangement::kRow},
    {v1::TILE_ARRANGEMENT_QUAD_2X2, TileArrangement::kQuad},
    {v1::TILE_ARRANGEMENT_SEPARATE_VIEWS, TileArrangement::kSeparate}};

constexpr EnumRow<v1::RgbdForm, std::optional<RgbdForm>> kRgbdForms[] = {
    {v1::RGBD_FORM_UNSPECIFIED, std::nullopt},
    {v1::RGBD_FORM_COLOR_DEPTH, RgbdForm::kColorDepth},
    {v1::RGBD_FORM_TWO_LAYERS, RgbdForm::kTwoLayers}};

constexpr EnumRow<v1::DepthPlacement, std::optional<DepthPlacement>> kDepthPlacements[] = {
    {v1::DEPTH_PLACEMENT_UNSPECIFIED, std::nullopt},
    {v1::DEPTH_PLACEMENT_RIGHT, DepthPlacement::kRight},
    {v1::DEPTH_PLACEMENT_LEFT, DepthPlacement::kLeft},
    {v1::DEPTH_PLACEMENT_TOP, DepthPlacement::kTop},
    {v1::DEPTH_PLACEMENT_BOTTOM, DepthPlacement::kBottom}};

constexpr EnumRow<v1::OutsideFill, OutsideFill> kOutsideFills[] = {
    {v1::OUTSIDE_FILL_UNSPECIFIED, OutsideFill::kBorder},
    {v1::OUTSIDE_FILL_BORDER, OutsideFill::kBorder},
    {v1::OUTSIDE_FILL_BACKGROUND, OutsideFill::kBackground}};

absl::StatusOr<std::vector<ViewCamera>> camerasFromProto(
    const google::protobuf::RepeatedPtrField<v1::Camera>& protos, const char* field) {
  std::vector<ViewCamera> cameras;
  for (const v1::Camera& proto : protos) {
    const std::string path = strCat(field, "[", cameras.size(), "]");
    const auto pose = poseFromProto(proto.pose(), "pose");
    VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(pose.status(), path));
    const auto projection = projectionFromProto(proto);
    VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(projection.status(), path));
    cameras.push_back({.pose = *pose, .projection = *projection});
  }
  return cameras;
}

absl::StatusOr<QuiltSpec> quiltFromProto(const v1::QuiltDisplay& proto) {
  const auto order = enumFromProto(proto.order(), "order", kQuiltOrders);
  VIEWLOOM_RETURN_IF_ERROR(order.status());
  const auto convention = enumFromProto(proto.convention(), "convention", kConventions);
  VIEWLOOM_RETURN_IF_ERROR(convention.status());
  return QuiltSpec{.preset = proto.preset(),
                   .columns = proto.columns(),
                   .rows = proto.rows(),
                   .size_px = sizeFromProto(proto.size()),
                   .aspect = proto.aspect(),
                   .view_cone_rad = proto.view_cone_rad(),
                   .focal_distance_m = proto.focal_distance_m(),
                   .fov_y_rad = proto.fov_y_rad(),
                   .order = *order,
                   .view_count = proto.view_count(),
                   .convention = *convention,
                   .depthiness = proto.depthiness()};
}

absl::StatusOr<StereoSpec> stereoFromProto(const v1::StereoDisplay& proto) {
  const auto layout = enumFromProto(proto.layout(), "layout", kStereoLayouts);
  VIEWLOOM_RETURN_IF_ERROR(layout.status());
  auto eyes = camerasFromProto(proto.eyes(), "eyes");
  VIEWLOOM_RETURN_IF_ERROR(eyes.status());
  StereoSpec stereo{.layout = *layout,
                    .eye_size_px = sizeFromProto(proto.eye_size()),
                    .focal_distance_m = proto.focal_distance_m(),
                    .fov_y_rad = proto.fov_y_rad(),
                    .eyes = *std::move(eyes),
                    .is_tracked = proto.tracked()};
  if (proto.eye_distance_m() != 0) stereo.eye_distance_m = proto.eye_distance_m();
  return stereo;
}

absl::StatusOr<CamerasSpec> camerasDisplayFromProto(const v1::CamerasDisplay& proto) {
  const auto order = enumFromProto(proto.order(), "order", kCamerasOrders);
  VIEWLOOM_RETURN_IF_ERROR(order.status());
  auto cameras = camerasFromProto(proto.cameras(), "cameras");
  VIEWLOOM_RETURN_IF_ERROR(cameras.status());
  const auto arrangement = enumFromProto(proto.arrangement(), "arrangement", kArrangements);
  VIEWLOOM_RETURN_IF_ERROR(arrangement.status());
  CamerasSpec spec{.cameras = *std::move(cameras),
                   .tile_size_px = sizeFromProto(proto.tile_size()),
                   .columns = proto.columns(),
                   .order = *order,
                   .arrangement = *arrangement};
  if (proto.has_grid()) {
    spec.grid = CameraGrid{.columns = proto.grid().columns(),
                           .rows = proto.grid().rows(),
                           .spacing_m = {proto.grid().spacing_x_m(), proto.grid().spacing_y_m()},
                           .focal_distance_m = proto.grid().focal_distance_m(),
                           .fov_y_rad = proto.grid().fov_y_rad()};
  }
  return spec;
}

absl::StatusOr<LenticularSpec> lenticularFromProto(const v1::LenticularDisplay& proto) {
  return LenticularSpec{.preset = proto.preset(),
                        .calibration_json = proto.calibration_json(),
                        .view_count = proto.view_count(),
                        .view_cone_rad = proto.view_cone_rad(),
                        .focal_distance_m = proto.focal_distance_m(),
                        .fov_y_rad = proto.fov_y_rad()};
}

absl::StatusOr<IntegralSpec> integralFromProto(const v1::IntegralDisplay& proto) {
  return IntegralSpec{.preset = proto.preset(),
                      .panel_px = sizeFromProto(proto.panel_size()),
                      .pixel_pitch_m = proto.pixel_pitch_m(),
                      .lens_pitch_m = proto.lens_pitch_m(),
                      .focal_length_m = proto.focal_length_m(),
                      .lens_columns = proto.lens_columns(),
                      .lens_rows = proto.lens_rows(),
                      .offset_px = {proto.offset_x_px(), proto.offset_y_px()},
                      .is_flipped = proto.flipped(),
                      .scale = proto.scale(),
                      .distance_m = proto.distance_m()};
}

absl::StatusOr<RgbdSpec> rgbdFromProto(const v1::RgbdDisplay& proto) {
  const auto form = enumFromProto(proto.form(), "form", kRgbdForms);
  VIEWLOOM_RETURN_IF_ERROR(form.status());
  const auto placement =
      enumFromProto(proto.depth_placement(), "depth_placement", kDepthPlacements);
  VIEWLOOM_RETURN_IF_ERROR(placement.status());
  return RgbdSpec{.preset = proto.preset(),
                  .view_size_px = sizeFromProto(proto.view_size()),
                  .form = *form,
                  .depth_placement = *placement,
                  .is_black_near = proto.black_near(),
                  .near_m = proto.near_m(),
                  .far_m = proto.far_m(),
                  .screen_m = proto.screen_m(),
                  .fov_y_rad = proto.fov_y_rad(),
                  .depth_bits = proto.depth_bits()};
}

// One of the converters above, its errors seen from the display.
template <typename Spec>
absl::Status assignKind(absl::StatusOr<Spec> kind, std::string_view field, DisplaySpec& spec) {
  if (!kind.ok()) return withFieldPrefix(kind.status(), field);
  spec.kind = *std::move(kind);
  return absl::OkStatus();
}

absl::Status assignNamed(std::string_view name, DisplaySpec& spec) {
  absl::StatusOr<DisplayKind> named = namedDisplay(name);
  if (!named.ok()) return named.status();
  spec.kind = *std::move(named);
  return absl::OkStatus();
}

absl::Status kindFromProto(const v1::Display& proto, DisplaySpec& spec) {
  switch (proto.kind_case()) {
    case v1::Display::kQuilt:
      return assignKind(quiltFromProto(proto.quilt()), "quilt", spec);
    case v1::Display::kStereo:
      return assignKind(stereoFromProto(proto.stereo()), "stereo", spec);
    case v1::Display::kCameras:
      return assignKind(camerasDisplayFromProto(proto.cameras()), "cameras", spec);
    case v1::Display::kLenticular:
      return assignKind(lenticularFromProto(proto.lenticular()), "lenticular", spec);
    case v1::Display::kIntegral:
      return assignKind(integralFromProto(proto.integral()), "integral", spec);
    case v1::Display::kRgbd:
      return assignKind(rgbdFromProto(proto.rgbd()), "rgbd", spec);
    case v1::Display::kPreset:
      return assignNamed(proto.preset(), spec);
    case v1::Display::KIND_NOT_SET:
      break;
  }
  return invalidField("kind",
                      "got none; accepted: quilt, stereo, cameras, lenticular, integral, "
                      "rgbd or preset");
}

ReflectionSpec reflectionFromProto(const v1::ReflectionEffect& proto) {
  return {.bounce_count = proto.bounces(),
          .sample_count = proto.samples(),
          .environment_rgb = proto.environment_rgb(),
          .is_filtered = !proto.unfiltered()};
}

absl::Status effectsFromProto(const v1::Display& proto, DisplaySpec& spec) {
  const v1::Effects& effects = proto.effects();
  if (effects.has_lens()) {
    const auto lens = lensFromProto(effects.lens());
    VIEWLOOM_RETURN_IF_ERROR(lens.status());
    spec.lens = *lens;
  }
  if (effects.has_temporal()) {
    const auto temporal = temporalFromProto(effects.temporal());
    VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(temporal.status(), "effects.temporal"));
    spec.temporal = *temporal;
  }
  if (effects.has_reflection()) spec.reflection = reflectionFromProto(effects.reflection());
  const auto quality = qualityFromProto(proto.quality());
  VIEWLOOM_RETURN_IF_ERROR(quality.status());
  spec.quality = *quality;
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<DisplaySpec> displayFromProto(const v1::Display& proto) {
  DisplaySpec spec;
  VIEWLOOM_RETURN_IF_ERROR(kindFromProto(proto, spec));
  VIEWLOOM_RETURN_IF_ERROR(effectsFromProto(proto, spec));
  spec.focus_following_s = proto.focus_following_s();
  if (proto.filter().sample_count() != 0) spec.filter.sample_count = proto.filter().sample_count();
  if (proto.filter().width() != 0) spec.filter.width = proto.filter().width();
  if (proto.has_world_pose()) {
    const auto pose = poseFromProto(proto.world_pose(), "world_pose");
    VIEWLOOM_RETURN_IF_ERROR(pose.status());
    spec.world_pose = *pose;
  }
  const auto outside_fill = enumFromProto(proto.outside_fill(), "outside_fill", kOutsideFills);
  VIEWLOOM_RETURN_IF_ERROR(outside_fill.status());
  spec.outside_fill = *outside_fill;
  if (proto.tolerance_px() != 0) spec.tolerance_px = proto.tolerance_px();
  spec.background_rgb = proto.background_rgb();
  return completeDisplaySpec(std::move(spec));
}

}  // namespace viewloom
