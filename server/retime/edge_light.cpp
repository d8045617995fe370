// SPDX-License-Identifier: Apache-2.0
#include "retime/edge_light.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include <glm/common.hpp>

namespace viewloom {
namespace {

// Light of two sides that differ by less, of what a channel may differ, cannot be told apart.
constexpr float kApartLeast = 0.03F;
// Below this share, the colour of a thing in a neighbouring pixel, or of the background in a pixel
// of the thing, is not derived from its own texture.
constexpr float kShareLeast = 0.1F;
// Where nothing says what is behind, a px that is less of a thing than this is no px of the thing:
// its light over its share would be mostly what noise has added.
constexpr float kShareAlone = 0.5F;
// px: from the middle of a px on the edge to that of one that holds some of its light, or of that
// of the px beside it, once it lies between px.
constexpr double kReach_px = 2;

// Work is shared among threads in pieces of this size.
constexpr uint32_t kPxPerPiece = 1024;

uint32_t pieceCount(uint32_t px_count) {
  return (px_count + kPxPerPiece - 1) / kPxPerPiece;
}

constexpr std::array<PxStep, 4> kSides{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

float dot(const Texel& a, const Texel& b) {
  float sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// The four px that a place lies between: from the corner on, by rows.
struct BetweenPx {
  explicit BetweenPx(const glm::dvec2& at_px)
      : corner(glm::floor(at_px - 0.5)), beyond(at_px - 0.5 - corner) {}

  float weight(int i) const {
    return float((i % 2 == 0 ? 1 - beyond.x : beyond.x) * (i / 2 == 0 ? 1 - beyond.y : beyond.y));
  }

  glm::dvec2 corner;
  glm::dvec2 beyond;
};

}  // namespace

void EdgeLight::find(const MovedSurfaces& surfaces, WorkerPool& workers) {
  const SizePx size_px = surfaces.sizePx();
  const LayerPlanes& front = surfaces.frame().sources.front().front();
  color_ = {front.color->data(), front.color_encoding};
  for (const Rim& rim : rims_) rim_of_px_[rim.px] = 0;
  for (const uint32_t px : reached_) nearest_[px] = 0;
  rims_.clear();
  reached_.clear();
  rim_of_px_.resize(size_px.area());
  nearest_.resize(size_px.area());
  findRims(surfaces, workers);
  std::vector<std::vector<uint32_t>> reached(workers.workerCount());
  const auto count = uint32_t(rims_.size());
  workers.forEach(pieceCount(count), [&](uint32_t piece, uint32_t worker) {
    const uint32_t end = std::min((piece + 1) * kPxPerPiece, count);
    for (uint32_t i = piece * kPxPerPiece; i < end; ++i) {
      if (rims_[i].near_px == rims_[i].px) offerAround(surfaces, rims_[i], reached[worker]);
    }
  });
  for (const std::vector<uint32_t>& px : reached) {
    reached_.insert(reached_.end(), px.begin(), px.end());
  }
}

void EdgeLight::findRims(const MovedSurfaces& surfaces, WorkerPool& workers) {
  const SizePx size_px = surfaces.sizePx();
  found_.resize(retimedPieceCount(size_px));
  for (std::vector<Rim>& found : found_) found.clear();
  forEachRow(size_px, workers, [&](uint32_t y, uint32_t) {
    const Columns columns = surfaces.rimColumns(y);
    std::vector<Rim>& found = found_[y / kRetimedRowsPerPiece];
    for (uint32_t x = columns.first; x < columns.end; ++x) {
      const uint32_t px = y * size_px.width + x;
      if (!surfaces.links().isBesideEdge(px)) continue;
      if (const auto rim = rimAt(surfaces, px)) found.push_back(*rim);
    }
  });
  for (const std::vector<Rim>& found : found_) {
    for (const Rim& rim : found) {
      rims_.push_back(rim);
      rim_of_px_[rim.px] = uint32_t(rims_.size());
    }
  }
}

// Chooses the side of the edge on which light differs most. A pixel of a thing belongs to the
// thing, whatever is beside it.
std::optional<EdgeLight::Rim> EdgeLight::rimAt(const MovedSurfaces& surfaces, uint32_t px) const {
  const EdgeSurroundings around(surfaces, color_);
  std::optional<Rim> found;
  float found_apart = -1;
  for (const PxStep step : kSides) {
    const auto other = around.beside(px, step);
    if (!other || !around.isEdge(px, *other)) continue;
    const bool is_near = surfaces.frontInvZ(px) > surfaces.frontInvZ(*other);
    const bool was_near = found && found->near_px == px;
    if (was_near && !is_near) continue;
    const EdgeSides sides = is_near ? around.sidesOf(px, *other, step)
                                    : around.sidesOf(*other, px, PxStep{-step.x, -step.y});
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
void EdgeLight::offerAround(const MovedSurfaces& surfaces, const Rim& rim,
                            std::vector<uint32_t>& reached) {
  const float inv_z = surfaces.invZ(rim.px);
  if (inv_z < 0) return;
  const SizePx size_px = surfaces.sizePx();
  const glm::dvec2 last_px(size_px.width - 1.0, size_px.height - 1.0);
  const glm::dvec2 at = surfaces.place(rim.px) - 0.5;
  const glm::dvec2 way = surfaces.way(rim.px);
  const glm::dvec2 first = glm::clamp(glm::ceil(at - kReach_px), glm::dvec2(0), last_px + 1.0);
  const glm::dvec2 last = glm::clamp(glm::floor(at + kReach_px), glm::dvec2(-1), last_px);
  if (first.x > last.x || first.y > last.y) return;
  const Shares shares = sharesFrom(surfaces, rim, first + 0.5 - way, last + 0.5 - way);
  const uint64_t offered =
      uint64_t{std::bit_cast<uint32_t>(inv_z + 0.0F)} << 32 | (UINT32_MAX - rim_of_px_[rim.px]);
  for (int y = int(first.y); y <= int(last.y); ++y) {
    for (int x = int(first.x); x <= int(last.x); ++x) {
      const uint32_t px = uint32_t(y) * size_px.width + uint32_t(x);
      const std::atomic_ref nearest(nearest_[px]);
      uint64_t known = nearest.load(std::memory_order_relaxed);
      if (offered <= known) continue;
      const BetweenPx between(glm::dvec2(x, y) + 0.5 - way);
      float share = 0;
      for (int i = 0; i < 4; ++i) {
        const auto column = size_t(int(between.corner.x) + i % 2 - shares.x);
        const auto row = size_t(int(between.corner.y) + i / 2 - shares.y);
        share += between.weight(i) * shares.shares[row][column];
      }
      if (share <= 0) continue;
      while (known < offered &&
             !nearest.compare_exchange_weak(known, offered, std::memory_order_relaxed)) {
      }
      if (known == 0) reached.push_back(px);  // by one thread alone
    }
  }
}

// Shares of the thing in the pixels of the frame around the places between these.
EdgeLight::Shares EdgeLight::sharesFrom(const MovedSurfaces& surfaces, const Rim& rim,
                                        const glm::dvec2& first_px,
                                        const glm::dvec2& last_px) const {
  const SizePx size_px = surfaces.sizePx();
  const glm::dvec2 begin = BetweenPx(first_px).corner, end = BetweenPx(last_px).corner + 1.0;
  Shares shares{.x = int(begin.x), .y = int(begin.y), .shares = {}};
  for (int y = shares.y; y <= int(end.y); ++y) {
    for (int x = shares.x; x <= int(end.x); ++x) {
      const uint32_t row = uint32_t(std::clamp(y, 0, int(size_px.height) - 1));
      const uint32_t column = uint32_t(std::clamp(x, 0, int(size_px.width) - 1));
      shares.shares[y - shares.y][x - shares.x] =
          shareOf(surfaces, rim, row * size_px.width + column);
    }
  }
  return shares;
}

float EdgeLight::shareOf(const MovedSurfaces& surfaces, const Rim& rim, uint32_t px) const {
  const uint32_t index = rim_of_px_[px];
  if (index != 0) {
    const Rim& other = rims_[index - 1];
    if (isOfThing(surfaces, rim, other.near_px)) return other.share;
  }
  return isOfThing(surfaces, rim, px) ? 1.0F : 0.0F;
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

// Share of the thing, between the pixels of the frame around the place.
EdgeLight::Part EdgeLight::partAt(const MovedSurfaces& surfaces, const Rim& rim,
                                  const glm::dvec2& at_px) const {
  const SizePx size_px = surfaces.sizePx();
  const BetweenPx between(at_px);
  const glm::dvec2 last_px(size_px.width - 1.0, size_px.height - 1.0);
  Part part;
  for (int i = 0; i < 4; ++i) {
    const glm::dvec2 px_at =
        glm::clamp(between.corner + glm::dvec2(i % 2, i / 2), glm::dvec2(0), last_px);
    const float weight = between.weight(i);
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
  const auto count = uint32_t(reached_.size());
  workers.forEach(pieceCount(count), [&](uint32_t piece, uint32_t) {
    const uint32_t end = std::min((piece + 1) * kPxPerPiece, count);
    for (uint32_t i = piece * kPxPerPiece; i < end; ++i) {
      const auto blended = blendAt(surfaces, drawn, reached_[i]);
      if (blended) storeTexel(color_.encoding, *blended, reached_[i], drawn.color);
    }
  });
}

}  // namespace viewloom
