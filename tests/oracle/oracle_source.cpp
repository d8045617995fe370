// SPDX-License-Identifier: Apache-2.0
#include "oracle/oracle_source.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <glm/common.hpp>

namespace viewloom::oracle {
namespace {

constexpr int kSlopeSignificantBits = 8;
constexpr int kSmallestSlopeExponent = -100;

float minmod(float a, float b) {
  if (!((a > 0 && b > 0) || (a < 0 && b < 0))) return 0;
  return std::abs(a) <= std::abs(b) ? a : b;
}

}  // namespace

float ConnectionTolerance::at(float nearer) const {
  return std::max(absolute, relative * (nearer - range.base()));
}

double ConnectionTolerance::at(double nearer) const {
  return std::max(double{absolute}, double{relative} * (nearer - double{range.base()}));
}

float ConnectionTolerance::deepStep(float nearer) const {
  constexpr float kShare = 0.15F;
  const float least = kShare * (1.0F / 3.0F) * (range.near - range.far);
  return std::max({absolute, least, kShare * (nearer - range.base())});
}

InvZPlanes makePlanes(int width, int height, int layer_count) {
  const size_t count = size_t(width) * size_t(height) * size_t(layer_count);
  return {width, height, layer_count, std::vector<float>(count, kNoSurface)};
}

InvZPlanes canonicalPlanes(const InvZPlanes& planes, float relative_step) {
  InvZPlanes result = makePlanes(planes.width, planes.height, planes.layer_count);
  std::vector<float> surfaces;
  for (int row = 0; row < planes.height; ++row) {
    for (int column = 0; column < planes.width; ++column) {
      surfaces.clear();
      for (int layer = 0; layer < planes.layer_count; ++layer) {
        const float inv_z = planes.at(layer, column, row);
        if (inv_z >= 0) surfaces.push_back(inv_z);
      }
      std::sort(surfaces.begin(), surfaces.end(), std::greater<>());
      int kept_count = 0;
      for (const float inv_z : surfaces) {
        const bool is_double = kept_count > 0 && result.at(kept_count - 1, column, row) - inv_z <=
                                                     relative_step * inv_z;
        if (is_double) continue;
        result.at(kept_count++, column, row) = inv_z;
      }
    }
  }
  return result;
}

float roundSlope(float slope) {
  int exponent = 0;
  const float mantissa = std::frexp(slope, &exponent);  // [0.5, 1)
  const float scaled = std::round(std::ldexp(mantissa, kSlopeSignificantBits));
  const float rounded = std::ldexp(scaled, exponent - kSlopeSignificantBits);
  return std::abs(slope) < std::ldexp(1.0f, kSmallestSlopeExponent) ? 0.0f : rounded;
}

OracleSource::OracleSource(InvZPlanes canonical_planes, Pinhole pinhole, ConnectionTolerance kappa)
    : planes_(std::move(canonical_planes)),
      pinhole_(pinhole),
      kappa_(kappa),
      facets_(planes_.inv_z.size()) {
  for (int layer = 0; layer < layerCount(); ++layer) {
    for (int row = 0; row < height(); ++row) {
      for (int column = 0; column < width(); ++column) {
        const FacetAt at{layer, column, row};
        Facet& facet = facets_[planes_.index(layer, column, row)];
        facet.inv_z = planes_.at(layer, column, row);
        if (facet.inv_z < 0) continue;
        facet.slope_x = roundSlope(slope(at, 1, 0));
        facet.slope_y = roundSlope(slope(at, 0, 1));
      }
    }
  }
}

double OracleSource::planeInvZ(const FacetAt& at, double x_px, double y_px) const {
  const Facet& f = facet(at);
  return double(f.inv_z) + double(f.slope_x) * (x_px - at.column - 0.5) +
         double(f.slope_y) * (y_px - at.row - 0.5);
}

// The signed change of inv_z on one step; neighbour.layer is -1 where nothing stands.
float OracleSource::differenceTo(const FacetAt& from, int step_x, int step_y,
                                 FacetAt& neighbour) const {
  neighbour = {-1, from.column + step_x, from.row + step_y};
  const bool inside = neighbour.column >= 0 && neighbour.column < width() && neighbour.row >= 0 &&
                      neighbour.row < height();
  if (!inside) return 0;
  const float inv_z = planes_.at(from.layer, from.column, from.row);
  float nearest = 0;
  for (int layer = 0; layer < layerCount(); ++layer) {
    const float other = planes_.at(layer, neighbour.column, neighbour.row);
    if (other < 0) continue;
    const float difference = other - inv_z;
    if (neighbour.layer < 0 || std::abs(difference) < std::abs(nearest)) {
      nearest = difference;
      neighbour.layer = layer;
    }
  }
  return nearest;
}

float OracleSource::oneSidedSlope(const FacetAt& at, int step_x, int step_y) const {
  FacetAt next, next_but_one;
  const float first = differenceTo(at, step_x, step_y, next);
  if (next.layer < 0) return 0;
  const float second = differenceTo(next, step_x, step_y, next_but_one);
  return next_but_one.layer < 0 ? 0 : minmod(first, second);
}

float OracleSource::slope(const FacetAt& at, int step_x, int step_y) const {
  FacetAt previous, next;
  const float backward = -differenceTo(at, -step_x, -step_y, previous);
  const float forward = differenceTo(at, step_x, step_y, next);
  if (previous.layer >= 0 && next.layer >= 0) return minmod(backward, forward);
  if (next.layer >= 0) return oneSidedSlope(at, step_x, step_y);
  if (previous.layer >= 0) return -oneSidedSlope(at, -step_x, -step_y);
  return 0;
}

float OracleSource::invZAtEdge(const FacetAt& at, const FacetAt& towards) const {
  const Facet& f = facet(at);
  const float half_step = towards.column != at.column
                              ? 0.5f * float(towards.column - at.column) * f.slope_x
                              : 0.5f * float(towards.row - at.row) * f.slope_y;
  return std::max(f.inv_z + half_step, 0.0f);
}

bool OracleSource::mayBeLinked(const FacetAt& a, const FacetAt& b) const {
  const float at_a = invZAtEdge(a, b);
  const float at_b = invZAtEdge(b, a);
  return std::abs(at_a - at_b) <= kappa_.at(std::max(at_a, at_b));
}

// The facet in the column of `towards` that is nearest to `from` at the shared edge, among those
// that are not linked within their own layer index.
FacetAt OracleSource::nearestUnlinked(const FacetAt& from, const FacetAt& towards) const {
  FacetAt nearest;
  float smallest = 0;
  for (int layer = 0; layer < layerCount(); ++layer) {
    const FacetAt candidate{layer, towards.column, towards.row};
    if (!exists(candidate) || !mayBeLinked(from, candidate)) continue;
    const FacetAt partner{layer, from.column, from.row};
    if (exists(partner) && mayBeLinked(partner, candidate)) continue;
    const float distance = std::abs(invZAtEdge(candidate, from) - invZAtEdge(from, candidate));
    if (nearest.layer < 0 || distance < smallest) {
      nearest = candidate;
      smallest = distance;
    }
  }
  return nearest;
}

bool OracleSource::linked(const FacetAt& a, const FacetAt& b) const {
  if (!exists(a) || !exists(b) || !mayBeLinked(a, b)) return false;
  if (a.layer == b.layer) return true;
  // Links within a layer come first: whoever has one is not free for another layer.
  const FacetAt beside_a{a.layer, b.column, b.row};
  const FacetAt beside_b{b.layer, a.column, a.row};
  if (exists(beside_a) && mayBeLinked(a, beside_a)) return false;
  if (exists(beside_b) && mayBeLinked(b, beside_b)) return false;
  return nearestUnlinked(a, b) == b && nearestUnlinked(b, a) == a;
}

bool OracleSource::isSilhouette(const FacetAt& at, const FacetAt& towards) const {
  for (int layer = 0; layer < layerCount(); ++layer) {
    if (linked(at, {layer, towards.column, towards.row})) return false;
  }
  return true;
}

bool OracleSource::deepBehind(const FacetAt& far, const FacetAt& near) const {
  if (!exists(far) || !exists(near) || !isSilhouette(far, near)) return false;
  const float near_inv_z = invZAtEdge(near, far);
  return near_inv_z - kappa_.deepStep(near_inv_z) > invZAtEdge(far, near);
}

bool OracleSource::knownBehind(const FacetAt& far, const FacetAt& near) const {
  if (!exists(far) || !exists(near) || !isSilhouette(near, far)) return false;
  const float far_inv_z = invZAtEdge(far, near);
  if (invZAtEdge(near, far) <= far_inv_z) return false;
  for (int layer = near.layer + 1; layer < layerCount(); ++layer) {
    const FacetAt deeper{layer, near.column, near.row};
    if (!exists(deeper)) continue;
    const float inv_z = invZAtEdge(deeper, far);
    if (inv_z - far_inv_z <= kappa_.at(std::max(inv_z, far_inv_z))) return true;
  }
  return false;
}

bool OracleSource::reachesAsFar(double far_inv_z, glm::dvec2 passed_px, glm::dvec2 met_px) const {
  const glm::dvec2 mirrored = glm::floor(2.0 * passed_px - met_px);
  if (mirrored.x < 0 || mirrored.x >= width() || mirrored.y < 0 || mirrored.y >= height()) {
    return true;
  }
  for (int layer = 0; layer < layerCount(); ++layer) {
    const FacetAt at{layer, int(mirrored.x), int(mirrored.y)};
    if (!exists(at)) continue;
    const double deep_step = kappa_.deepStep(float(far_inv_z));
    if (std::abs(double{facet(at).inv_z} - far_inv_z) <= deep_step) return true;
  }
  return false;
}

}  // namespace viewloom::oracle
