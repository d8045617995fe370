// SPDX-License-Identifier: Apache-2.0
#include "display/source_advice.h"

#include <algorithm>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "display/source_demand.h"

namespace viewloom {
namespace {

constexpr uint32_t kLayersForParallax = 2;  // what is seen, and what the nearest hides
constexpr uint32_t kLayersForWideGaps = 3;

absl::Status requireOwnFov(const DisplaySpec& spec) {
  const auto fov = std::visit([](const auto& kind) { return openFov(kind); }, spec.kind);
  if (!fov || fov->fov_y_rad > 0) return absl::OkStatus();
  return invalidField(
      fov->field,
      "missing: without a stream, there is no field of view to copy; accepted is the vertical "
      "field of view, up to 2.6 rad (148.969 degrees)");
}

absl::Status checkRequest(const DisplaySpec& spec, double near_m, double far_m) {
  VIEWLOOM_RETURN_IF_ERROR(
      checkRange(near_m, {kFocalDistanceMin_m, kFocalDistanceMax_m}, "near_m"));
  VIEWLOOM_RETURN_IF_ERROR(checkRange(far_m, {near_m, kFocalDistanceMax_m}, "far_m"));
  return withFieldPrefix(requireOwnFov(spec), "display");
}

// Layout for a scene between the two depths, without a source whose values it could take.
absl::StatusOr<AtlasLayout> layoutOf(const DisplaySpec& spec, const InvZRange& range) {
  StreamDefaults defaults;
  defaults.source_intrinsics = {.focal_px = {1, 1}, .principal_px = {0.5, 0.5}};
  defaults.source_size_px = {.width = 1, .height = 1};
  defaults.focal_distance_m = 2 / (range.near + range.far);
  defaults.inv_z_near = range.near;
  defaults.inv_z_far = range.far;
  absl::StatusOr<AtlasLayout> layout = makeAtlasLayout(spec, defaults);
  if (!layout.ok()) return withFieldPrefix(layout.status(), "display");
  return layout;
}

// In the middle of the box around all eyes, turned as the view in the middle.
Pose middleEye(const OutermostViews& views, const View& middle_view) {
  glm::dvec3 low_m = views.cameras.front().pose.position_m;
  glm::dvec3 high_m = low_m;
  for (const Camera& view : views.cameras) {
    low_m = glm::min(low_m, view.pose.position_m);
    high_m = glm::max(high_m, view.pose.position_m);
  }
  return {.position_m = (low_m + high_m) / 2.0, .orientation = middle_view.camera.pose.orientation};
}

SourceDemand demandAt(const OutermostViews& views, const Pose& pose, const InvZRange& range) {
  SourceDemand demand;
  demand.include(views, inverse(pose), range);
  return demand;
}

AdvisedSource sourceFor(const SourceDemand& demand, const Pose& pose) {
  const SizePx size_px = demand.sizePx();
  return {.camera = {.pose = pose, .intrinsics = intrinsicsFromFov(demand.fov(), size_px)},
          .size_px = size_px};
}

}  // namespace

absl::StatusOr<SourceAdvice> adviseSource(const DisplaySpec& spec, double near_m, double far_m) {
  VIEWLOOM_RETURN_IF_ERROR(checkRequest(spec, near_m, far_m));
  const InvZRange range{.far = 1 / far_m, .near = 1 / near_m};
  const absl::StatusOr<AtlasLayout> layout = layoutOf(spec, range);
  VIEWLOOM_RETURN_IF_ERROR(layout.status());
  const OutermostViews views = outermostViews(*layout);
  const Pose middle = middleEye(views, layout->views[layout->views.size() / 2]);
  const auto besideMiddle = [&](const Camera& view) {
    return glm::distance(view.pose.position_m, middle.position_m);
  };
  const Camera& outermost = *std::max_element(
      views.cameras.begin(), views.cameras.end(),
      [&](const Camera& a, const Camera& b) { return besideMiddle(a) < besideMiddle(b); });
  const SourceDemand demand = demandAt(views, middle, range);
  if (!demand.isServable()) {
    return fieldError(absl::StatusCode::kFailedPrecondition, "display",
                      "its views look more than 1.3 rad aside from the middle one, further than a "
                      "pinhole camera sees; give it a narrower view cone or field of view");
  }
  const double gap = besideMiddle(outermost) * (range.near - range.far);
  const bool is_wide = gap > kWideGapShare * demand.tangentWidth();
  const bool needs_parallax = besideMiddle(outermost) > 0 || hasLayerBehind(spec);
  const Pose world = spec.world_pose.value_or(Pose{});
  SourceAdvice advice{.source = sourceFor(demand, middle),
                      .layer_count = needs_parallax ? kLayersForParallax : 1,
                      .second_source = std::nullopt};
  if (is_wide) {
    const Pose end{.position_m = outermost.pose.position_m, .orientation = middle.orientation};
    const SourceDemand end_demand = demandAt(views, end, range);
    advice.layer_count = kLayersForWideGaps;
    if (end_demand.isServable()) advice.second_source = sourceFor(end_demand, end);
    if (advice.second_source) advice.second_source->camera.pose = compose(world, end);
  }
  advice.source.camera.pose = compose(world, middle);
  return advice;
}

}  // namespace viewloom
