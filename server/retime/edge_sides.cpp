// SPDX-License-Identifier: Apache-2.0
#include "retime/edge_sides.h"

#include <algorithm>

#include <glm/common.hpp>

namespace viewloom {
namespace {

// px: edges on both sides of which everything goes the same way stay as they are.
constexpr double kSameWay_px = 1e-3;

}  // namespace

std::optional<uint32_t> EdgeSurroundings::beside(uint32_t px, PxStep step) const {
  const int x = int(px % size_px_.width) + step.x, y = int(px / size_px_.width) + step.y;
  if (x < 0 || y < 0 || x >= int(size_px_.width) || y >= int(size_px_.height)) {
    return std::nullopt;
  }
  return uint32_t(y) * size_px_.width + uint32_t(x);
}

bool EdgeSurroundings::isEdge(uint32_t px, uint32_t other) const {
  const float inv_z = surfaces_.frontInvZ(px), others = surfaces_.frontInvZ(other);
  if (inv_z < 0 || others < 0 || inv_z == others) return false;
  if (surfaces_.links().areJoined(px, other)) return false;
  const glm::dvec2 apart_px = glm::abs(surfaces_.way(px) - surfaces_.way(other));
  return std::max(apart_px.x, apart_px.y) > kSameWay_px;
}

EdgeSides EdgeSurroundings::sidesOf(uint32_t near_px, uint32_t far_px, PxStep step) const {
  const Texel far = farLight(near_px, far_px, step);
  return {.far = far, .between = mixed(lightTowards(near_px, {-step.x, -step.y}), 1, far, -1)};
}

// Light of the far side. A deeper layer may hold the hidden surface: then it is taken between that
// and the pixel beyond the edge, unless that pixel is at another edge.
Texel EdgeSurroundings::farLight(uint32_t near_px, uint32_t far_px, PxStep step) const {
  const SurfaceLinks& links = surfaces_.links();
  const auto behind = links.joinedBehind(near_px, far_px);
  if (!behind) return lightTowards(far_px, step);
  const LayerPlanes& layer = surfaces_.frame().sources.front()[surfaces_.layerOf(*behind)];
  const Texel hidden = ColorPlane{layer.color->data(), layer.color_encoding}.at(near_px);
  const auto first = beside(far_px, step);
  if (!first || !links.areJoined(far_px, *first)) return hidden;
  const auto second = beside(*first, step);
  if (!second || !links.areJoined(*first, *second)) return hidden;
  return mixed(hidden, 0.5F, color_.at(*first), 0.5F);
}

// Colour of the surface at `px`, from the pixel behind it and the one behind that: at an edge the
// pixel itself may hold the light of two surfaces.
Texel EdgeSurroundings::lightTowards(uint32_t px, PxStep step) const {
  const SurfaceLinks& links = surfaces_.links();
  const auto first = beside(px, step);
  if (!first || !links.areJoined(px, *first)) return color_.at(px);
  const auto second = beside(*first, step);
  if (!second || !links.areJoined(*first, *second)) return color_.at(*first);
  Texel light = mixed(color_.at(*first), 2, color_.at(*second), -1);
  const float most = color_.encoding == PlaneEncoding::kRgba8 ? 255.0F : 65504.0F;
  for (float& channel : light) channel = std::clamp(channel, 0.0F, most);
  return light;
}

}  // namespace viewloom
