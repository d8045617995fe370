// SPDX-License-Identifier: Apache-2.0
#include "rpc/wanted_to_proto.h"

#include "base/check.h"
#include "rpc/geometry_to_proto.h"

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
  proto.set_layer_count(demand.hasParallax() ? kLayersForParallax : 1);
  *proto.mutable_pose() = poseToProto(pose);
  return proto;
}

}  // namespace viewloom
