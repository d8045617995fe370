// SPDX-License-Identifier: Apache-2.0
#include "retime/fresh_grid.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include <glm/common.hpp>

namespace viewloom {
namespace {

// Pieces of surface that a sample owns, in the low bits of their number: its px as it stands, the
// two triangles of the quad that it begins, the four quadrants of its footprint.
constexpr uint32_t kPieceKinds = 8;
constexpr uint32_t kStillPx = 0;
constexpr uint32_t kUpperTriangle = 1;
constexpr uint32_t kLowerTriangle = 2;
constexpr uint32_t kFirstQuadrant = 3;
// All samples of the largest source have numbers.
static_assert(uint64_t{8192} * 8192 * 4 * kPieceKinds <= UINT32_MAX);

// Share of a triangle by which a px may lie outside of it and count: rounding, so that px on the
// edge between two belong to one at least.
constexpr double kEdgeSlack = 1e-6;
// The same in px, of the largest that are drawn: more than theirs.
constexpr double kEdgeSlack_px = 1e-4;

double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

// Of a place in the triangle; none outside of it.
std::optional<std::array<double, 3>> sharesIn(const std::array<glm::dvec2, 3>& corners,
                                              const glm::dvec2& at) {
  const double area = cross(corners[1] - corners[0], corners[2] - corners[0]);
  if (area == 0) return std::nullopt;
  std::array<double, 3> shares;
  for (size_t i = 0; i < 3; ++i) {
    shares[i] = cross(corners[(i + 1) % 3] - at, corners[(i + 2) % 3] - at) / area;
    if (!(shares[i] >= -kEdgeSlack)) return std::nullopt;
  }
  return shares;
}

// Half-open, so that the footprints of samples a px apart meet and do not overlap.
bool isInQuadrant(uint32_t quadrant, const glm::dvec2& from_sample) {
  const bool is_left = quadrant == 0 || quadrant == 3;
  const bool is_top = quadrant < 2;
  const auto is_inside = [](double distance, bool is_before) {
    return is_before ? distance >= -0.5 && distance < 0 : distance >= 0 && distance < 0.5;
  };
  return is_inside(from_sample.x, is_left) && is_inside(from_sample.y, is_top);
}

// Half of a quad.
class Triangle {
 public:
  Triangle(const MovedSurfaces& surfaces, const std::array<uint32_t, 4>& quad, bool is_upper)
      : samples_(is_upper ? std::array{quad[0], quad[1], quad[3]}
                          : std::array{quad[1], quad[2], quad[3]}) {
    for (size_t i = 0; i < 3; ++i) corners_[i] = surfaces.place(samples_[i]);
  }

  glm::dvec2 low() const { return glm::min(glm::min(corners_[0], corners_[1]), corners_[2]); }
  glm::dvec2 high() const { return glm::max(glm::max(corners_[0], corners_[1]), corners_[2]); }
  std::optional<Blend> blendAt(const glm::dvec2& at) const {
    const auto shares = sharesIn(corners_, at);
    if (!shares) return std::nullopt;
    return Blend{.samples = samples_, .shares = *shares, .count = 3};
  }

 private:
  std::array<uint32_t, 3> samples_;
  std::array<glm::dvec2, 3> corners_;
};

// The samples around a px if it lies in the piece.
std::optional<Blend> blendOf(const MovedSurfaces& surfaces, uint32_t piece, const glm::dvec2& at) {
  const uint32_t sample = piece / kPieceKinds;
  const uint32_t kind = piece % kPieceKinds;
  if (kind == kStillPx) return Blend{.samples = {sample}, .shares = {1}, .count = 1};
  if (kind >= kFirstQuadrant) {
    if (!isInQuadrant(kind - kFirstQuadrant, at - surfaces.place(sample))) return std::nullopt;
    return Blend{.samples = {sample}, .shares = {1}, .count = 1};
  }
  const Triangle triangle(surfaces, *surfaces.quadFrom(sample), kind == kUpperTriangle);
  return triangle.blendAt(at);
}

uint64_t keyOf(float inv_z, uint32_t piece) {
  return uint64_t{std::bit_cast<uint32_t>(inv_z)} << 32 | (UINT32_MAX - piece);
}

float invZOf(const MovedSurfaces& surfaces, const Blend& blend) {
  double inv_z = 0;
  for (uint32_t i = 0; i < blend.count; ++i) {
    inv_z += blend.shares[i] * double{surfaces.invZ(blend.samples[i])};
  }
  return std::max(float(inv_z), 0.0F) + 0.0F;  // never -0, whose bits would be the largest
}

}  // namespace

void FreshGrid::drawFirst(const MovedSurfaces& surfaces, WorkerPool& workers) {
  size_px_ = surfaces.sizePx();
  kappa_ = surfaces.kappa();
  in_front_.resize(size_px_.area());
  is_first_ = true;
  draw(surfaces, workers);
}

void FreshGrid::drawNext(const MovedSurfaces& surfaces, WorkerPool& workers) {
  for (uint32_t px = 0; px < size_px_.area(); ++px) in_front_[px] = invZ(px);
  is_first_ = false;
  draw(surfaces, workers);
}

void FreshGrid::draw(const MovedSurfaces& surfaces, WorkerPool& workers) {
  nearest_.resize(size_px_.area());
  const auto overRows = [&](const auto& work) {
    workers.forEach(retimedPieceCount(size_px_), [&](uint32_t piece, uint32_t) {
      const uint32_t first = piece * kRetimedRowsPerPiece;
      const uint32_t end = std::min(first + kRetimedRowsPerPiece, size_px_.height);
      for (uint32_t y = first; y < end; ++y) work(y);
    });
  };
  overRows([&](uint32_t y) { drawStillRow(surfaces, y); });
  overRows([&](uint32_t y) {
    const MovedSurfaces::Columns columns = surfaces.quadColumns(y);
    for (uint32_t layer = 0; layer < surfaces.layerCount(); ++layer) {
      const uint32_t row = surfaces.sampleAt(layer, 0, y);
      for (uint32_t x = columns.first; x < columns.end; ++x) drawSample(surfaces, row + x);
    }
  });
}

// Each px by itself; nothing else is there yet.
void FreshGrid::drawStillRow(const MovedSurfaces& surfaces, uint32_t y) {
  const uint32_t row = y * size_px_.width;
  std::fill_n(nearest_.begin() + row, size_px_.width, uint64_t{0});
  for (uint32_t layer = 0; layer < surfaces.layerCount(); ++layer) {
    const uint32_t first = surfaces.sampleAt(layer, 0, y);
    for (uint32_t x = 0; x < size_px_.width; ++x) {
      const uint32_t sample = first + x;
      if (!surfaces.exists(sample) || !surfaces.isStill(sample)) continue;
      const float inv_z = surfaces.invZ(sample) + 0.0F;
      if (!isBehind(row + x, inv_z, 0)) continue;
      nearest_[row + x] =
          std::max(nearest_[row + x], keyOf(inv_z, sample * kPieceKinds + kStillPx));
    }
  }
}

void FreshGrid::drawSample(const MovedSurfaces& surfaces, uint32_t sample) {
  if (!surfaces.exists(sample)) return;
  const uint32_t first_piece = sample * kPieceKinds;
  if (!surfaces.isStill(sample)) {
    const glm::dvec2 at = surfaces.place(sample);
    for (uint32_t i = 0; i < 4; ++i) {
      if ((surfaces.quadrantsInQuads(sample) & (1U << i)) != 0) continue;
      const uint32_t piece = first_piece + kFirstQuadrant + i;
      drawPiece(surfaces, piece, at - 0.5, at + 0.5,
                [&](const glm::dvec2& place) { return blendOf(surfaces, piece, place); });
    }
  }
  const auto quad = surfaces.quadFrom(sample);
  if (!quad) return;
  if (std::all_of(quad->begin(), quad->end(), [&](uint32_t s) { return surfaces.isStill(s); })) {
    return;  // their px are drawn
  }
  for (const uint32_t kind : {kUpperTriangle, kLowerTriangle}) {
    const Triangle triangle(surfaces, *quad, kind == kUpperTriangle);
    drawPiece(surfaces, first_piece + kind, triangle.low(), triangle.high(),
              [&](const glm::dvec2& place) { return triangle.blendAt(place); });
  }
}

// Offers the piece to the px whose middles lie between these places.
template <typename BlendAt>
void FreshGrid::drawPiece(const MovedSurfaces& surfaces, uint32_t piece, const glm::dvec2& low_px,
                          const glm::dvec2& high_px, const BlendAt& blendAt) {
  const glm::dvec2 last_px(size_px_.width - 1.0, size_px_.height - 1.0);
  // Places far outside would not fit an integer.
  const glm::dvec2 first =
      glm::clamp(glm::ceil(low_px - 0.5 - kEdgeSlack_px), glm::dvec2(0), last_px + 1.0);
  const glm::dvec2 last =
      glm::clamp(glm::floor(high_px - 0.5 + kEdgeSlack_px), glm::dvec2(-1), last_px);
  for (int y = int(first.y); y <= int(last.y); ++y) {
    for (int x = int(first.x); x <= int(last.x); ++x) {
      const std::optional<Blend> blend = blendAt(glm::dvec2(x + 0.5, y + 0.5));
      if (!blend) continue;
      offer(uint32_t(y) * size_px_.width + uint32_t(x), invZOf(surfaces, *blend), piece);
    }
  }
}

// What stands has layers of its own, one behind the other.
bool FreshGrid::isBehind(uint32_t px, float inv_z, float apart) const {
  return is_first_ || (in_front_[px] >= 0 && in_front_[px] - inv_z > apart);
}

// Of what moves, pieces that lie beside each other may both reach over a px: no further apart than
// kappa they are one surface.
void FreshGrid::offer(uint32_t px, float inv_z, uint32_t piece) {
  const float in_front = is_first_ ? 0 : std::max(in_front_[px], 0.0F);
  if (!isBehind(px, inv_z, std::max(kappa_.absolute, kappa_.relative * in_front))) return;
  const uint64_t offered = keyOf(inv_z, piece);
  const std::atomic_ref nearest(nearest_[px]);
  uint64_t known = nearest.load(std::memory_order_relaxed);
  while (known < offered &&
         !nearest.compare_exchange_weak(known, offered, std::memory_order_relaxed)) {
  }
}

std::optional<uint32_t> FreshGrid::stillSample(uint32_t px) const {
  const uint32_t piece = UINT32_MAX - uint32_t(nearest_[px]);
  if (nearest_[px] == 0 || piece % kPieceKinds != kStillPx) return std::nullopt;
  return piece / kPieceKinds;
}

float FreshGrid::invZ(uint32_t px) const {
  return nearest_[px] == 0 ? abi::kNoSurface : std::bit_cast<float>(uint32_t(nearest_[px] >> 32));
}

Blend FreshGrid::blend(const MovedSurfaces& surfaces, uint32_t px) const {
  const uint32_t piece = UINT32_MAX - uint32_t(nearest_[px]);
  return *blendOf(surfaces, piece, {px % size_px_.width + 0.5, px / size_px_.width + 0.5});
}

}  // namespace viewloom
