// SPDX-License-Identifier: Apache-2.0
#include "rpc/source_wants.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/check.h"
#include "rpc/layout_to_proto.h"
#include "rpc/report_to_proto.h"

namespace viewloom {
namespace {

// One surface for what is seen, one for what the nearest hides; 1 when no view leaves the source.
constexpr uint32_t kLayersForParallax = 2;

// Exact where a display stands in its source: rounding must not look like a step aside.
Pose sourceFromDisplay(const EncodedAtlas& atlas) {
  if (atlas.display_pose == atlas.source_camera.pose) return {};
  return compose(inverse(atlas.source_camera.pose), atlas.display_pose);
}

// Relative to the source. Where every display follows eyes, one between them all serves them best.
Pose wantedPose(std::span<const AtlasPtr> atlases) {
  Pose mean{.position_m = glm::dvec3(0.0), .orientation = {0, 0, 0, 0}};
  double eye_count = 0;
  for (const AtlasPtr& atlas : atlases) {
    if (atlas->eye_poses_latched_ns == 0) return {};
    const Pose source_from_display = sourceFromDisplay(*atlas);
    for (const View& view : atlas->layout->views) {
      const Pose eye = compose(source_from_display, view.camera.pose);
      mean.position_m += eye.position_m;
      // Both signs are the same turn.
      const bool is_alike = glm::dot(mean.orientation, eye.orientation) >= 0;
      mean.orientation = mean.orientation + (is_alike ? eye.orientation : -eye.orientation);
      ++eye_count;
    }
  }
  if (eye_count == 0) return {};
  return {.position_m = mean.position_m / eye_count,
          .orientation = glm::normalize(mean.orientation)};
}

}  // namespace

v1::Wanted wantedToProto(std::span<const AtlasPtr> atlases, std::span<const InvZRange> depths,
                         uint32_t display_count) {
  VIEWLOOM_CHECK(depths.size() == atlases.size());
  SourceDemand demand;
  const Pose pose = wantedPose(atlases);
  for (size_t i = 0; i < atlases.size(); ++i) {
    demand.include(outermostViews(*atlases[i]->layout),
                   compose(inverse(pose), sourceFromDisplay(*atlases[i])), depths[i]);
  }
  v1::Wanted proto;
  proto.set_display_count(display_count);
  if (atlases.empty()) return proto;
  *proto.mutable_size() = sizeToProto(demand.sizePx());
  *proto.mutable_fov() = fovToProto(demand.fov());
  // One eye that moves sees past edges as soon as the next picture.
  const bool has_eyes = std::ranges::any_of(
      atlases, [](const AtlasPtr& atlas) { return atlas->eye_poses_latched_ns != 0; });
  proto.set_layer_count(demand.hasParallax() || has_eyes ? kLayersForParallax : 1);
  *proto.mutable_pose() = poseToProto(pose);
  return proto;
}

v1::Wanted SourceWants::wanted(std::span<const AtlasPtr> atlases, uint32_t display_count) {
  keepDisplays(atlases);
  std::vector<InvZRange> depths;
  for (const AtlasPtr& atlas : atlases) {
    depths.push_back(displays_[atlas->display_id].depths.settle(
        {.far = atlas->stats.inv_z_far, .near = atlas->stats.inv_z_near}));
  }
  v1::Wanted wanted = wantedToProto(atlases, depths, display_count);
  for (const AtlasPtr& atlas : atlases) {
    const std::vector<ViewsOutside> runs =
        displays_[atlas->display_id].shares.settle(atlas->outside_shares);
    if (runs.empty()) continue;
    v1::DisplayOutside& outside = *wanted.add_outside();
    outside.set_display_id(atlas->display_id);
    for (const ViewsOutside& views : runs) *outside.add_views() = outsideToProto(views);
  }
  return wanted;
}

void SourceWants::keepDisplays(std::span<const AtlasPtr> atlases) {
  std::map<uint64_t, Display> before = std::exchange(displays_, {});
  for (const AtlasPtr& atlas : atlases) {
    Display& display = displays_[atlas->display_id];
    if (const auto known = before.find(atlas->display_id); known != before.end()) {
      display = std::move(known->second);
    }
    const bool is_same = display.layout == atlas->layout &&
                         display.source_camera == atlas->source_camera &&
                         display.display_pose == atlas->display_pose;
    if (!is_same) {
      display = {.layout = atlas->layout,
                 .source_camera = atlas->source_camera,
                 .display_pose = atlas->display_pose,
                 .shares = {},
                 .depths = {}};
    }
  }
}

}  // namespace viewloom
