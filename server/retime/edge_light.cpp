// SPDX-License-Identifier: Apache-2.0
#include "retime/edge_light.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/common.hpp>

namespace viewloom {
namespace {

// px: edges on both sides of which everything goes the same way stay as they are.
constexpr double kSameWay_px = 1e-3;
// Light of two sides that differ by less, of what a channel may differ, cannot be told apart.
constexpr float kApartLeast = 0.03F;
// What a thing has in a px beside it, or what is behind in a px of the thing, is not told from
// their own texture below this share.
constexpr float kShareLeast = 0.1F;
// Where nothing says what is behind, a px that is less of a thing than this is no px of the thing:
// its light over its share would be mostly what noise has added.
constexpr float kShareAlone = 0.5F;
// px: from the middle of a px on the edge to that of one that holds some of its light, or of that
// of the px beside it, once it lies between px.
constexpr double kReach_px = 2;

struct PxStep {
  int x = 0;
  int y = 0;
};
constexpr std::array<PxStep, 4> kSides{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

Texel mixed(const Texel& a, float share_a, const Texel& b, float share_b) {
  Texel sum;
  for (size_t i = 0; i < sum.size(); ++i) sum[i] = share_a * a[i] + share_b * b[i];
  return sum;
}

float dot(const Texel& a, const Texel& b) {
  float sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// Looks along rows and columns of the first layer, as the frame has it.
class Layer {
 public:
  Layer(const MovedSurfaces& surfaces, const ColorPlane& color)
      : surfaces_(surfaces), color_(color), size_px_(surfaces.sizePx()) {}

  std::optional<uint32_t> beside(uint32_t px, PxStep step) const {
    const int x = int(px % size_px_.width) + step.x, y = int(px / size_px_.width) + step.y;
    if (x < 0 || y < 0 || x >= int(size_px_.width) || y >= int(size_px_.height)) {
      return std::nullopt;
    }
    return uint32_t(y) * size_px_.width + uint32_t(x);
  }

  // Two surfaces that go different ways.
  bool isEdge(uint32_t px, uint32_t other) const {
    const float inv_z = surfaces_.frontInvZ(px), others = surfaces_.frontInvZ(other);
    if (inv_z < 0 || others < 0 || inv_z == others || areJoined(px, other)) return false;
    const glm::dvec2 apart_px = glm::abs(surfaces_.way(px) - surfaces_.way(other));
    return std::max(apart_px.x, apart_px.y) > kSameWay_px;
  }

  // Of an edge between two px, with `step` from the near one to the far one. What is a px wide
  // shows its own light.
  EdgeSides sidesOf(uint32_t near_px, uint32_t far_px, PxStep step) const {
    const Texel far = farLight(near_px, far_px, step);
    return {.far = far, .between = mixed(lightTowards(near_px, {-step.x, -step.y}), 1, far, -1)};
  }

 private:
  bool areJoined(uint32_t px, uint32_t other) const {
    const uint32_t first = std::min(px, other);
    const bool are_in_row = size_px_.width > 1 && std::max(px, other) - first == 1;
    return are_in_row ? surfaces_.joinsRight(first) : surfaces_.joinsBelow(first);
  }

  // Of the far side: where a deeper layer holds what the near one hides, between that and the px
  // beyond the edge, if that is not at another edge.
  Texel farLight(uint32_t near_px, uint32_t far_px, PxStep step) const {
    const auto behind = surfaces_.joinedBehind(near_px, far_px);
    if (!behind) return lightTowards(far_px, step);
    const LayerPlanes& layer = surfaces_.frame().sources.front()[surfaces_.layerOf(*behind)];
    const Texel hidden = ColorPlane{layer.color->data(), layer.color_encoding}.at(near_px);
    const auto first = beside(far_px, step);
    if (!first || !areJoined(far_px, *first)) return hidden;
    const auto second = beside(*first, step);
    if (!second || !areJoined(*first, *second)) return hidden;
    return mixed(hidden, 0.5F, color_.at(*first), 0.5F);
  }

  // What the surface at `px` looks like by the px behind it, and the one behind that: at an edge
  // the px itself may hold the light of two.
  Texel lightTowards(uint32_t px, PxStep step) const {
    const auto first = beside(px, step);
    if (!first || !areJoined(px, *first)) return color_.at(px);
    const auto second = beside(*first, step);
    if (!second || !areJoined(*first, *second)) return color_.at(*first);
    Texel light = mixed(color_.at(*first), 2, color_.at(*second), -1);
    const float most = color_.encoding == PlaneEncoding::kRgba8 ? 255.0F : 65504.0F;
    for (float& channel : light) channel = std::clamp(channel, 0.0F, most);
    return light;
  }

  const MovedSurfaces& surfaces_;
  const ColorPlane& color_;
  const SizePx size_px_;
};

}  // namespace

void EdgeLight::find(const MovedSurfaces& surfaces, WorkerPool& workers) {
  const SizePx size_px = surfaces.sizePx();
  const LayerPlanes& front = surfaces.frame().sources.front().front();
  color_ = {front.color->data(), front.color_encoding};
  found_.resize(retimedPieceCount(size_px));
  workers.forEach(retimedPieceCount(size_px), [&](uint32_t piece, uint32_t) {
    found_[piece].clear();
    const uint32_t first = piece * kRetimedRowsPerPiece * size_px.width;
    const uint32_t end =
        std::min(first + kRetimedRowsPerPiece * size_px.width, uint32_t(size_px.area()));
    for (uint32_t px = first; px < end; ++px) {
      if (!surfaces.isBesideEdge(px)) continue;
      if (const auto rim = rimAt(surfaces, px)) found_[piece].push_back(*rim);
    }
  });
  for (const Rim& rim : rims_) rim_of_px_[rim.px] = 0;
  for (const uint32_t px : reached_) nearest_[px] = 0;
  rims_.clear();
  reached_.clear();
  rim_of_px_.resize(size_px.area());
  nearest_.resize(size_px.area());
  for (const std::vector<Rim>& found : found_) {
    for (const Rim& rim : found) {
      rims_.push_back(rim);
      rim_of_px_[rim.px] = uint32_t(rims_.size());
    }
  }
  for (const Rim& rim : rims_) {
    if (rim.near_px == rim.px) offerAround(surfaces, rim);
  }
}

// Of the sides on which there is an edge, the one on which light differs most. A px of a thing is
// one of the thing, whatever it is beside.
std::optional<EdgeLight::Rim> EdgeLight::rimAt(const MovedSurfaces& surfaces, uint32_t px) const {
  const Layer layer(surfaces, color_);
  std::optional<Rim> found;
  float found_apart = -1;
  for (const PxStep step : kSides) {
    const auto other = layer.beside(px, step);
    if (!other || !layer.isEdge(px, *other)) continue;
    const bool is_near = surfaces.frontInvZ(px) > surfaces.frontInvZ(*other);
    const bool was_near = found && found->near_px == px;
    if (was_near && !is_near) continue;
    const EdgeSides sides = is_near ? layer.sidesOf(px, *other, step)
                                    : layer.sidesOf(*other, px, PxStep{-step.x, -step.y});
    const float apart = dot(sides.between, sides.between);
    if (found && was_near == is_near && apart <= found_apart) continue;
    found = {.px = px,
             .near_px = is_near ? px : *other,
             .far_px = is_near ? *other : px,
             .share = is_near ? 1.0F : 0.0F,
             .light = is_near ? color_.at(px) : Texel{},
             .clean = color_.at(px)};
    found_apart = apart;
    takeApart(sides, apart, *found);
  }
  return found;
}

// By how far the px's light is from what is behind towards the thing's.
void EdgeLight::takeApart(const EdgeSides& sides, float apart, Rim& rim) const {
  const float range = color_.encoding == PlaneEncoding::kRgba8 ? 255.0F : 1.0F;
  if (!(apart > kApartLeast * kApartLeast * range * range)) return;
  const Texel own = rim.clean;
  const float share =
      std::clamp(dot(mixed(own, 1, sides.far, -1), sides.between) / apart, 0.0F, 1.0F);
  if (std::abs(share - rim.share) < kShareLeast) return;
  rim.share = share;
  rim.light = mixed(own, 1, sides.far, share - 1);
  rim.clean = sides.far;
}

const Texel* EdgeLight::cleanAt(uint32_t sample) const {
  if (sample >= rim_of_px_.size() || rim_of_px_[sample] == 0) return nullptr;
  const Rim& rim = rims_[rim_of_px_[sample] - 1];
  return rim.near_px != sample && rim.share > 0 ? &rim.clean : nullptr;
}

// The px that some of the thing's edge falls into: of all such edges, the nearest counts.
void EdgeLight::offerAround(const MovedSurfaces& surfaces, const Rim& rim) {
  const float inv_z = surfaces.invZ(rim.px);
  if (inv_z < 0) return;
  const SizePx size_px = surfaces.sizePx();
  const glm::dvec2 last_px(size_px.width - 1.0, size_px.height - 1.0);
  const glm::dvec2 at = surfaces.place(rim.px) - 0.5;
  const glm::dvec2 first = glm::clamp(glm::ceil(at - kReach_px), glm::dvec2(0), last_px + 1.0);
  const glm::dvec2 last = glm::clamp(glm::floor(at + kReach_px), glm::dvec2(-1), last_px);
  const uint64_t offered =
      uint64_t{std::bit_cast<uint32_t>(inv_z + 0.0F)} << 32 | (UINT32_MAX - rim_of_px_[rim.px]);
  for (int y = int(first.y); y <= int(last.y); ++y) {
    for (int x = int(first.x); x <= int(last.x); ++x) {
      const uint32_t px = uint32_t(y) * size_px.width + uint32_t(x);
      if (offered <= nearest_[px]) continue;
      const glm::dvec2 from_px = glm::dvec2(x, y) + 0.5 - surfaces.way(rim.px);
      if (partAt(surfaces, rim, from_px).share <= 0) continue;
      if (nearest_[px] == 0) reached_.push_back(px);
      nearest_[px] = offered;
    }
  }
}

// Whether a sample belongs to the thing at the edge, rather than to what is behind it.
bool EdgeLight::isOfThing(const MovedSurfaces& surfaces, const Rim& rim, uint32_t sample) const {
  const auto isNearer = [](float value, float near, float far) {
    return std::abs(value - near) < std::abs(value - far);
  };
  const auto apart_px = [&](uint32_t other) {
    const glm::dvec2 apart = glm::abs(surfaces.way(sample) - surfaces.way(other));
    return apart.x + apart.y;
  };
  return surfaces.exists(sample) && apart_px(rim.px) < apart_px(rim.far_px) &&
         isNearer(surfaces.invZ(sample), surfaces.invZ(rim.px), surfaces.invZ(rim.far_px));
}

// Of the thing, between the px of the frame that the place lies between.
EdgeLight::Part EdgeLight::partAt(const MovedSurfaces& surfaces, const Rim& rim,
                                  const glm::dvec2& at_px) const {
  const SizePx size_px = surfaces.sizePx();
  const glm::dvec2 corner = glm::floor(at_px - 0.5);
  const glm::dvec2 beyond = at_px - 0.5 - corner;
  const glm::dvec2 last_px(size_px.width - 1.0, size_px.height - 1.0);
  Part part;
  for (uint32_t i = 0; i < 4; ++i) {
    const glm::dvec2 px_at = glm::clamp(corner + glm::dvec2(i % 2, i / 2), glm::dvec2(0), last_px);
    const auto weight =
        float((i % 2 == 0 ? 1 - beyond.x : beyond.x) * (i / 2 == 0 ? 1 - beyond.y : beyond.y));
    const uint32_t px = uint32_t(px_at.y) * size_px.width + uint32_t(px_at.x);
    const uint32_t index = rim_of_px_[px];
    const Rim* const other = index == 0 ? nullptr : &rims_[index - 1];
    if (other != nullptr && isOfThing(surfaces, rim, other->near_px)) {
      part.share += weight * other->share;
      part.light = mixed(part.light, 1, other->light, weight);
    } else if (isOfThing(surfaces, rim, px)) {
      part.share += weight;
      part.light = mixed(part.light, 1, other != nullptr ? other->clean : color_.at(px), weight);
    }
  }
  return part;
}

std::optional<Texel> EdgeLight::blendAt(const MovedSurfaces& surfaces, const Drawn& drawn,
                                        uint32_t px) const {
  const Rim& rim = rims_[UINT32_MAX - uint32_t(nearest_[px]) - 1];
  const uint32_t sample = drawn.sample[px];
  if (sample == kNoSample) return std::nullopt;
  const bool shows_thing = isOfThing(surfaces, rim, sample);
  // Something else is before it.
  if (!shows_thing && drawn.inv_z[px] > surfaces.invZ(rim.px)) return std::nullopt;
  const uint32_t width = surfaces.sizePx().width;
  const glm::dvec2 at(px % width + 0.5, px / width + 0.5);
  const Part part = partAt(surfaces, rim, at - surfaces.way(rim.px));
  const bool is_known =
      !shows_thing || (drawn.inv_z_behind != nullptr && drawn.inv_z_behind[px] >= 0);
  if (part.share <= 0) return std::nullopt;
  if (!is_known) {
    if (part.share < kShareAlone) return std::nullopt;
    return mixed(part.light, 1 / part.share, Texel{}, 0);
  }
  const Texel behind =
      shows_thing ? drawn.behind.at(px) : ColorPlane{drawn.color, color_.encoding}.at(px);
  return mixed(part.light, 1, behind, 1 - part.share);
}

void EdgeLight::blendInto(const MovedSurfaces& surfaces, const Drawn& drawn, WorkerPool& workers) {
  constexpr uint32_t kPxPerPiece = 1024;
  const auto count = uint32_t(reached_.size());
  workers.forEach((count + kPxPerPiece - 1) / kPxPerPiece, [&](uint32_t piece, uint32_t) {
    const uint32_t end = std::min((piece + 1) * kPxPerPiece, count);
    for (uint32_t i = piece * kPxPerPiece; i < end; ++i) {
      const auto blended = blendAt(surfaces, drawn, reached_[i]);
      if (blended) storeTexel(color_.encoding, *blended, reached_[i], drawn.color);
    }
  });
}

}  // namespace viewloom
