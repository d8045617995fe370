// SPDX-License-Identifier: Apache-2.0
#include "rpc/wanted_to_proto.h"

#include "display/source_demand.h"
#include "rpc/geometry_to_proto.h"

namespace viewloom {
namespace {

// One surface for what is seen, one for what the nearest hides; 1 when no view leaves the source.
constexpr uint32_t kLayersForParallax = 2;
// A display's atlas says nothing of how near things come: views are seen as from far away.
constexpr InvZRange kFarAway;

// Exact where a display stands in its source: rounding must not look like a step aside.
Pose sourceFromDisplay(const EncodedAtlas& atlas) {
  if (atlas.display_pose == atlas.source_camera.pose) return {};
  return compose(inverse(atlas.source_camera.pose), atlas.display_pose);
}

}  // namespace

v1::Wanted wantedToProto(std::span<const AtlasPtr> atlases, uint32_t display_count) {
  SourceDemand demand(kFarAway);
  for (const AtlasPtr& atlas : atlases) {
    demand.include(outermostViews(*atlas->layout), sourceFromDisplay(*atlas));
  }
  v1::Wanted proto;
  proto.set_display_count(display_count);
  if (atlases.empty()) return proto;
  *proto.mutable_size() = sizeToProto(demand.sizePx());
  *proto.mutable_fov() = fovToProto(demand.fov());
  proto.set_layer_count(demand.hasParallax() ? kLayersForParallax : 1);
  *proto.mutable_pose() = poseToProto({});
  return proto;
}

}  // namespace viewloom
