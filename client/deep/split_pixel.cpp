// SPDX-License-Identifier: Apache-2.0
#include "deep/split_pixel.h"

#include <algorithm>
#include <limits>

#include <glm/common.hpp>

namespace viewloom::deep {
namespace {

constexpr double kHiddenWeight = 1.0 / 16;

// errors[last][first]: of one group of the points first..last.
using GroupErrors = std::array<std::array<double, kPointsMax>, kPointsMax>;

// Sums over the points before an index.
struct Sums {
  std::array<double, kPointsMax + 1> weight{};
  std::array<double, kPointsMax + 1> weighted_inv_z{};
};

Sums sumsOf(std::span<const DeepPoint> points) {
  Sums sums;
  double transmittance = 1;
  for (size_t i = 0; i < points.size(); ++i) {
    const double weight = presence(points[i]) * std::max(transmittance, kHiddenWeight);
    sums.weight[i + 1] = sums.weight[i] + weight;
    sums.weighted_inv_z[i + 1] = sums.weighted_inv_z[i] + weight * points[i].inv_z;
    transmittance *= 1 - points[i].alpha;
  }
  return sums;
}

// The sum of weight * (1/Z - inv_z) over points begin..end-1.
double excess(const Sums& sums, size_t begin, size_t end, double inv_z) {
  return sums.weighted_inv_z[end] - sums.weighted_inv_z[begin] -
         inv_z * (sums.weight[end] - sums.weight[begin]);
}

void computeErrors(std::span<const DeepPoint> points, GroupErrors& errors) {
  const Sums sums = sumsOf(points);
  for (size_t first = 0; first < points.size(); ++first) {
    double transmittance = 1;
    double contribution = 0;
    double contributed_inv_z = 0;
    size_t beyond = first;  // the first point that is not nearer than the group's 1/Z
    for (size_t last = first; last < points.size(); ++last) {
      const double share = presence(points[last]) * transmittance;
      contribution += share;
      contributed_inv_z += share * points[last].inv_z;
      transmittance *= 1 - points[last].alpha;
      // Points only get further away, so the mean does, too.
      const double inv_z = contributed_inv_z / contribution;
      while (beyond < last && points[beyond].inv_z > inv_z) ++beyond;
      const double error =
          excess(sums, first, beyond, inv_z) - excess(sums, beyond, last + 1, inv_z);
      errors[last][first] = std::max(error, 0.0);  // never less but by rounding
    }
  }
}

}  // namespace

double presence(const DeepPoint& point) {
  const glm::dvec3 color = glm::abs(point.color);
  const double light = std::max({color.r, color.g, color.b});
  return std::max(point.alpha, std::min(light, 1.0));
}

DeepPoint joined(std::span<const DeepPoint> group) {
  if (group.size() == 1) return group.front();
  DeepPoint all;
  double transmittance = 1;
  double contribution = 0;
  for (const DeepPoint& point : group) {
    const double share = presence(point) * transmittance;
    contribution += share;
    all.inv_z += share * point.inv_z;
    all.color += transmittance * point.color;
    transmittance *= 1 - point.alpha;
  }
  all.inv_z /= contribution;
  all.alpha = 1 - transmittance;
  return all;
}

Partition partitionPoints(std::span<const DeepPoint> points, uint32_t group_count_max) {
  const auto count = static_cast<uint32_t>(points.size());
  const uint32_t groups = std::min(count, group_count_max);
  GroupErrors errors;
  computeErrors(points, errors);

  // least[g][last]: of points 0..last in g + 1 groups; begins[g][last]: where the last one begins.
  std::array<std::array<double, kPointsMax>, kGroupsMax> least{};
  std::array<std::array<uint32_t, kPointsMax>, kGroupsMax> begins{};
  for (uint32_t last = 0; last < count; ++last) {
    least[0][last] = errors[last][0];
    begins[0][last] = 0;
    for (uint32_t g = 1; g < groups; ++g) {
      least[g][last] = std::numeric_limits<double>::infinity();
      for (uint32_t begin = g; begin <= last; ++begin) {
        const double error = least[g - 1][begin - 1] + errors[last][begin];
        if (error >= least[g][last]) continue;
        least[g][last] = error;
        begins[g][last] = begin;
      }
    }
  }

  Partition partition{.group_count = groups, .error_per_m = least[groups - 1][count - 1]};
  uint32_t end = count;
  for (uint32_t g = groups; g-- > 0;) {
    partition.ends[g] = end;
    end = begins[g][end - 1];
  }
  return partition;
}

namespace {

// Share of 1/Z: a twentieth of the step that the server takes for one surface. It is far more than
// a step of binary16 depth, at which the server would take two layers for the same.
constexpr double kCloseShare = 1.0 / 1024;

}  // namespace

void PixelSplitter::joinClose(std::span<const DeepPoint> points, double share) {
  distinct_.clear();
  for (size_t begin = 0; begin < points.size();) {
    const double least_inv_z = (1 - share) * points[begin].inv_z;
    size_t end = begin + 1;
    while (end < points.size() && points[end].inv_z >= least_inv_z) ++end;
    distinct_.push_back(joined(points.subspan(begin, end - begin)));
    begin = end;
  }
}

SplitPixel PixelSplitter::split(std::span<const DeepPoint> points) {
  // Ends: from a share of 1 on, all points are close.
  for (double share = kCloseShare;; share *= 2) {
    joinClose(points, share);
    if (distinct_.size() <= kPointsMax) break;
  }
  SplitPixel pixel;
  const std::span<const DeepPoint> distinct = distinct_;
  if (distinct.size() <= layer_count_max_) {
    pixel.layer_count = static_cast<uint32_t>(distinct.size());
    for (size_t i = 0; i < distinct.size(); ++i) pixel.layers[i] = distinct[i];
    return pixel;
  }
  const Partition partition = partitionPoints(distinct, layer_count_max_);
  pixel.layer_count = partition.group_count;
  pixel.is_merged = true;
  pixel.error_per_m = partition.error_per_m;
  size_t begin = 0;
  for (uint32_t g = 0; g < partition.group_count; ++g) {
    pixel.layers[g] = joined(distinct.subspan(begin, partition.ends[g] - begin));
    begin = partition.ends[g];
  }
  return pixel;
}

}  // namespace viewloom::deep
