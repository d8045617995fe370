// SPDX-License-Identifier: Apache-2.0
#include "cli/inspected_display.h"

#include <cmath>
#include <numbers>
#include <variant>

#include "base/str_cat.h"
#include "cli/outside_text.h"
#include "messages/display_from_proto.h"
#include "messages/source_from_proto.h"

namespace viewloom::cli {
namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;
// Farthest share of all surfaces: the sky is not among the others.
constexpr double kFarShare = 0.02;

absl::StatusOr<Camera> cameraOf(const v1::Camera& proto, SizePx size_px) {
  const absl::StatusOr<Pose> pose = poseFromProto(proto.pose(), "pose");
  if (!pose.ok()) return pose.status();
  const auto projection = projectionFromProto(proto);
  if (!projection.ok()) return projection.status();
  const Fov* const fov = std::get_if<Fov>(&*projection);
  return Camera{.pose = *pose,
                .intrinsics = fov == nullptr ? std::get<Intrinsics>(*projection)
                                             : intrinsicsFromFov(*fov, size_px)};
}

InvZRange rangeOf(const inspect::LayerInspection& layer) {
  const auto sky = static_cast<double>(layer.samples.sky_count);
  const auto all = sky + static_cast<double>(layer.samples.surface_count);
  return {.far = sky > kFarShare * all ? 0 : double{layer.measures.inv_z_far},
          .near = double{layer.measures.inv_z_near}};
}

int degrees(double low_rad, double high_rad) {
  return static_cast<int>(std::ceil((high_rad - low_rad) * kDegPerRad));
}

}  // namespace

absl::StatusOr<DisplayNeed> displayNeed(const v1::Display& display, const v1::Source& source,
                                        const inspect::SourceInspection& inspected) {
  const absl::StatusOr<DisplaySpec> spec = displayFromProto(display);
  if (!spec.ok()) return spec.status();
  if (source.cube_map()) return DisplayNeed{};
  const inspect::LayerInspection& layer = inspected.layers.front();
  const SizePx size_px{layer.depth.size().width(), layer.depth.size().height()};
  const absl::StatusOr<Camera> camera = cameraOf(inspected.camera, size_px);
  if (!camera.ok()) return camera.status();
  const InvZRange range = rangeOf(layer);
  const SourceStats stats{.inv_z_min = range.far,
                          .inv_z_max = range.near,
                          .inv_z_near = range.near,
                          .inv_z_far = range.far};
  const absl::StatusOr<AtlasLayout> layout =
      makeAtlasLayout(*spec, {.source_intrinsics = camera->intrinsics,
                              .source_size_px = size_px,
                              .focal_distance_m = contentFocalDistance(stats)});
  if (!layout.ok()) return layout.status();
  const Pose from_display =
      spec->world_pose ? compose(inverse(camera->pose), *spec->world_pose) : Pose{};
  SourceDemand demand;
  demand.include(outermostViews(*layout), from_display, range);
  return DisplayNeed{.outside = viewsOutside(
                         outsideShares(*layout, from_display, camera->intrinsics, size_px, range)),
                     .wanted_fov = demand.fov()};
}

std::string needText(const DisplayNeed& need) {
  if (need.outside.empty()) return "no view sees past the edge of the source";
  google::protobuf::RepeatedPtrField<v1::ViewsOutside> views;
  for (const ViewsOutside& run : need.outside) {
    v1::ViewsOutside& entry = *views.Add();
    entry.set_first_view(run.first_view);
    entry.set_last_view(run.last_view);
    entry.set_share(run.share);
  }
  return strCat("past the edge of the source see ", outsideText(views),
                ". They need a field of view of ",
                degrees(need.wanted_fov.left_rad, need.wanted_fov.right_rad), " x ",
                degrees(need.wanted_fov.down_rad, need.wanted_fov.up_rad), " degrees");
}

nlohmann::json needJson(const DisplayNeed& need) {
  nlohmann::json outside = nlohmann::json::array();
  for (const ViewsOutside& run : need.outside) {
    outside.push_back(
        {{"first_view", run.first_view}, {"last_view", run.last_view}, {"share", run.share}});
  }
  return {{"views_outside", outside},
          {"wanted_fov_rad",
           {{"left", need.wanted_fov.left_rad},
            {"right", need.wanted_fov.right_rad},
            {"up", need.wanted_fov.up_rad},
            {"down", need.wanted_fov.down_rad}}}};
}

}  // namespace viewloom::cli
