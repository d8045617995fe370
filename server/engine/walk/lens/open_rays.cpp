// SPDX-License-Identifier: Apache-2.0
#include "lens/open_rays.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "lens/cells.h"

namespace viewloom {
namespace {

// How closely the place is looked for where a ray passes behind something, px.
constexpr float kPassage_px = 0.25F;

// Where a ray is in the image is linear in 1/Z, px.
struct Path {
  glm::vec2 far;   // where that is 0
  glm::vec2 pace;  // for each 1/m

  // The same as makeLensRay in shaders/lib/lens/lens_rays.glsl.
  Path(const GatheredRays& rays, const OpenRay& open) {
    const abi::ViewParams& view = rays.view;
    const LensPoint& point = rays.points[open.point];
    const glm::vec2 lens(point.x[open.px], -point.y[open.px]);
    const glm::vec2 moved = view.lens_px_m * lens;
    const glm::vec2 in_block(open.px % abi::kMetBlockSide_px, open.px / abi::kMetBlockSide_px);
    const glm::vec2 beside(point.beside_x_px, point.beside_y_px);
    const glm::vec2 px = glm::vec2(rays.first_x_px, rays.first_y_px) + in_block + 0.5F + beside;
    const glm::vec2 step = px - view.lens_inv_focus * moved;
    const glm::vec3 eye = view.eye + moved.x * view.direction_dx + moved.y * view.direction_dy;
    const glm::vec3 direction =
        view.direction + step.x * view.direction_dx + step.y * view.direction_dy;
    far = glm::vec2(direction) / direction.z;
    pace = glm::vec2(eye) - eye.z * far;
  }

  glm::vec2 at(float inv_z) const { return far + inv_z * pace; }

  // The 1/Z of a sheet where the ray meets it; < 0: nowhere.
  float meetingOf(const glm::vec3& plane) const {
    const float at_far = glm::dot(plane, glm::vec3(far, 1));
    const float inv_z = at_far / (1 - glm::dot(glm::vec2(plane), pace));
    return std::isfinite(inv_z) ? inv_z : -1.0F;
  }
};

// A ray and the facets of a layer.
struct Passing {
  const HostStructure& structure;
  const Path& path;
  uint32_t layer;

  // The 1/Z of the layer; < 0: it has no surface there.
  float surfaceAt(glm::vec2 place) const {
    const bool is_inside = place.x >= 0 && place.y >= 0 &&
                           place.x < float(structure.size_px.width) &&
                           place.y < float(structure.size_px.height);
    if (!is_inside) return -1;
    const SurfaceCell facet = surfaceCell(structure, layer, abi::kLevelFacets, glm::uvec2(place));
    return facet.is_plane ? facet.at(place - glm::floor(place) - 0.5F) : -1.0F;
  }
  // Whether the layer is before the ray once that is as far back as this.
  bool isBehind(float inv_z) const { return surfaceAt(path.at(inv_z)) > inv_z; }
  int32_t texelAt(glm::vec2 place) const {
    const glm::uvec2 px(place);
    return int32_t(layer * structure.color_stride + px.y * structure.size_px.width + px.x);
  }
};

// The nearest sheet of the layer that the ray is behind something of it at; or its end.
std::optional<float> hiddenAt(const GatheredRays& rays, const Passing& passing) {
  std::optional<float> hidden;
  for (const abi::MetSheet& sheet : rays.sheets) {
    if (sheet.layer != passing.layer) continue;
    const float inv_z = passing.path.meetingOf(sheet.plane);
    if (inv_z >= 0 && inv_z > hidden.value_or(-1) && passing.isBehind(inv_z)) hidden = inv_z;
  }
  if (!hidden && passing.isBehind(0)) hidden = 0.0F;
  return hidden;
}

}  // namespace

// The deepest layer that hides it counts, as in a walk.
int32_t guessSeen(const GatheredRays& rays, const OpenRay& open) {
  const HostStructure& structure = rays.structure;
  const Path path(rays, open);
  for (uint32_t layer = structure.layer_count; layer-- > 0;) {
    const Passing passing{structure, path, layer};
    const std::optional<float> hidden = hiddenAt(rays, passing);
    if (!hidden) continue;
    float behind = *hidden;
    // It begins in front of everything: somewhere between it passes behind something.
    float front = std::max(structure.inv_z_max * abi::kInvZNearMargin, behind);
    float way_px = glm::length(path.pace) * (front - behind);
    if (!std::isfinite(way_px)) continue;  // an eye so far away that halving would never end
    for (; way_px > kPassage_px; way_px /= 2) {
      const float middle = 0.5F * (front + behind);
      (passing.isBehind(middle) ? behind : front) = middle;
    }
    const float far_side = passing.surfaceAt(path.at(front));
    const float near_side = passing.surfaceAt(path.at(behind));
    if (far_side < 0) continue;
    const bool is_linked =
        std::abs(near_side - far_side) <= structure.kappa.at(std::max(near_side, far_side));
    return passing.texelAt(path.at(is_linked ? behind : front));
  }
  return kNothingSeen;
}

}  // namespace viewloom
