// SPDX-License-Identifier: Apache-2.0
#include "rpc/wanted_to_proto.h"

#include <algorithm>
#include <cmath>

#include "frame/limits.h"
#include "rpc/geometry_to_proto.h"

namespace viewloom {
namespace {

// Tangent of the widest half angle a pinhole can serve, that of 2.6 rad: what looks further to the
// side, or back, asks for this much.
const double kTangentMax = std::tan(1.3);
// One surface for what is seen, one for what the nearest hides; 1 when no view leaves the source.
constexpr uint32_t kLayersForParallax = 2;

// The union of what views see from the source, as tangents, and the sharpest of them.
struct Demand {
  double left = kTangentMax;
  double right = -kTangentMax;
  double up = -kTangentMax;
  double down = kTangentMax;
  glm::dvec2 focal_px{0.0};
  bool parallax = false;

  void includeDirection(const glm::dvec3& direction) {
    const double ahead = -direction.z;
    const auto tangent = [ahead](double sideways) {
      if (ahead <= 0) return std::copysign(kTangentMax, sideways);
      return std::clamp(sideways / ahead, -kTangentMax, kTangentMax);
    };
    left = std::min(left, tangent(direction.x));
    right = std::max(right, tangent(direction.x));
    down = std::min(down, tangent(direction.y));
    up = std::max(up, tangent(direction.y));
  }

  void includeView(const Camera& view, SizePx tile_size_px) {
    const Fov fov = fovFromIntrinsics(view.intrinsics, tile_size_px);
    for (const double x : {std::tan(fov.left_rad), std::tan(fov.right_rad)}) {
      for (const double y : {std::tan(fov.down_rad), std::tan(fov.up_rad)}) {
        includeDirection(view.pose.orientation * glm::dvec3(x, y, -1));
      }
    }
    focal_px = glm::max(focal_px, view.intrinsics.focal_px);
    parallax = parallax || view.pose.position_m != glm::dvec3(0.0);
  }
};

uint32_t sidePx(double focal_px, double tangent_extent) {
  const double most_px = FrameLimits{}.plane_side_px_max;
  return static_cast<uint32_t>(std::ceil(std::min(focal_px * tangent_extent, most_px)));
}

// Exact where a display stands in its source: rounding must not look like a step aside.
Pose sourceFromDisplay(const EncodedAtlas& atlas) {
  if (atlas.display_pose == atlas.source_camera.pose) return {};
  return compose(inverse(atlas.source_camera.pose), atlas.display_pose);
}

}  // namespace

v1::Wanted wantedToProto(std::span<const AtlasPtr> atlases, uint32_t display_count) {
  Demand demand;
  for (const AtlasPtr& atlas : atlases) {
    const Pose source_from_display = sourceFromDisplay(*atlas);
    for (const View& view : atlas->layout->views) {
      const Camera seen{.pose = compose(source_from_display, view.camera.pose),
                        .intrinsics = view.camera.intrinsics};
      demand.includeView(seen, atlas->layout->tile_size_px);
    }
  }
  v1::Wanted proto;
  proto.set_display_count(display_count);
  if (atlases.empty()) return proto;
  proto.mutable_size()->set_width(sidePx(demand.focal_px.x, demand.right - demand.left));
  proto.mutable_size()->set_height(sidePx(demand.focal_px.y, demand.up - demand.down));
  *proto.mutable_fov() = fovToProto({.left_rad = std::atan(demand.left),
                                     .right_rad = std::atan(demand.right),
                                     .up_rad = std::atan(demand.up),
                                     .down_rad = std::atan(demand.down)});
  proto.set_layer_count(demand.parallax ? kLayersForParallax : 1);
  *proto.mutable_pose() = poseToProto({});
  return proto;
}

}  // namespace viewloom
