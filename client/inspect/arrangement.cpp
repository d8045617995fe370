// SPDX-License-Identifier: Apache-2.0
#include "inspect/arrangement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

namespace viewloom::inspect {
namespace {

// Neighbours that differ by more in 1/Z belong to different areas.
constexpr float kAreaStep = 0.1F;
constexpr size_t kIslandCells = 8;       // smaller areas are none
constexpr double kIslandsShare = 0.02;   // of the image, that far islands have at least
constexpr double kIslandsDominance = 4;  // ... and so many times what near islands have

// Reach of the test for planes: three cells in a row, so far apart.
constexpr uint32_t kBendReach = 4;
constexpr float kBendSlope = 0.02F;   // of the depth, from the first to the last
constexpr float kBendEvenness = 2;    // both halves rise alike: no edge lies between
constexpr float kStraighter = 0.25F;  // of the other's bend: it is straight instead
constexpr double kBendDominance = 4;
constexpr double kBendShare = 0.02;  // of all cells

// The depth on a grid of gridStride_px.
class Grid {
 public:
  explicit Grid(const DepthSamples& samples) {
    const uint32_t stride = samples.gridStride_px();
    width_ = (samples.width_px + stride - 1) / stride;
    height_ = (samples.height_px + stride - 1) / stride;
    for (uint32_t y = 0; y < height_; ++y) {
      for (uint32_t x = 0; x < width_; ++x) {
        inv_z_.push_back(samples.inv_z[size_t{y} * stride * samples.width_px + size_t{x} * stride]);
      }
    }
  }

  uint32_t width() const { return width_; }
  uint32_t height() const { return height_; }
  size_t cellCount() const { return inv_z_.size(); }
  size_t index(uint32_t x, uint32_t y) const { return size_t{y} * width_ + x; }
  float at(size_t index) const { return inv_z_[index]; }

 private:
  uint32_t width_ = 0, height_ = 0;
  std::vector<float> inv_z_;
};

// Areas without a step inside, as sets of cells.
class Areas {
 public:
  explicit Areas(const Grid& grid) : grid_(grid), parent_(grid.cellCount()) {
    std::iota(parent_.begin(), parent_.end(), size_t{0});
    forEachPair([this](size_t a, size_t b) {
      if (isOneSurface(a, b)) parent_[root(a)] = root(b);
    });
  }

  struct Islands {
    size_t nearer_cells = 0, farther_cells = 0, farther_count = 0;
  };

  // Areas that touch no side of the image, by whether they are nearer than what is around them.
  Islands islands() {
    std::vector<size_t> cells(parent_.size());
    std::vector<uint8_t> is_at_rim(parent_.size());
    std::vector<int64_t> nearer_than_around(parent_.size());
    for (uint32_t y = 0; y < grid_.height(); ++y) {
      for (uint32_t x = 0; x < grid_.width(); ++x) {
        const size_t area = root(grid_.index(x, y));
        ++cells[area];
        const bool is_rim = x == 0 || y == 0 || x + 1 == grid_.width() || y + 1 == grid_.height();
        if (is_rim) is_at_rim[area] = 1;
      }
    }
    forEachPair([&](size_t a, size_t b) {
      const size_t area_a = root(a), area_b = root(b);
      if (area_a == area_b || grid_.at(a) < 0 || grid_.at(b) < 0) return;
      const int64_t sign = grid_.at(a) > grid_.at(b) ? 1 : -1;
      nearer_than_around[area_a] += sign;
      nearer_than_around[area_b] -= sign;
    });
    Islands islands;
    for (size_t area = 0; area < parent_.size(); ++area) {
      if (root(area) != area || is_at_rim[area] != 0 || cells[area] < kIslandCells) continue;
      if (nearer_than_around[area] > 0) islands.nearer_cells += cells[area];
      if (nearer_than_around[area] >= 0) continue;
      islands.farther_cells += cells[area];
      ++islands.farther_count;
    }
    return islands;
  }

 private:
  static bool isNear(float a, float b) {
    return (a < 0) == (b < 0) && std::abs(a - b) <= kAreaStep * std::max(a, b);
  }

  // Neighbours, to the right or below: alike, or on the slope on either side of them.
  bool isOneSurface(size_t a, size_t b) const {
    const float here = grid_.at(a), next = grid_.at(b);
    if (isNear(here, next)) return true;
    if (here < 0 || next < 0) return false;
    const size_t step = b - a;
    const size_t column = a % grid_.width();
    const bool is_in_row = step == 1;
    const bool has_before = is_in_row ? column > 0 : a >= step;
    const bool has_after = is_in_row ? column + 2 < grid_.width() : b + step < grid_.cellCount();
    const auto continues = [](float outer, float inner, float across) {
      return outer >= 0 && isNear(2 * inner - outer, across);
    };
    return (has_before && continues(grid_.at(a - step), here, next)) ||
           (has_after && continues(grid_.at(b + step), next, here));
  }

  template <typename Visit>
  void forEachPair(const Visit& visit) {
    for (uint32_t y = 0; y < grid_.height(); ++y) {
      for (uint32_t x = 0; x < grid_.width(); ++x) {
        const size_t here = grid_.index(x, y);
        if (x + 1 < grid_.width()) visit(here, here + 1);
        if (y + 1 < grid_.height()) visit(here, here + grid_.width());
      }
    }
  }

  size_t root(size_t cell) {
    while (parent_[cell] != cell) cell = parent_[cell] = parent_[parent_[cell]];
    return cell;
  }

  const Grid& grid_;
  std::vector<size_t> parent_;
};

bool hasFarIslands(const Grid& grid) {
  const Areas::Islands islands = Areas(grid).islands();
  return islands.farther_count >= 2 &&
         double(islands.farther_cells) >= kIslandsShare * double(grid.cellCount()) &&
         double(islands.farther_cells) >= kIslandsDominance * double(islands.nearer_cells);
}

// How far three values are from a line, as a share of their rise; negative when there is none to
// judge: no clear slope, or an edge.
float bendOf(float first, float middle, float last) {
  const float rise = last - first;
  const float before = middle - first, after = last - middle;
  if (!(std::abs(rise) > kBendSlope * middle) || !(before * after > 0)) return -1;
  const auto [less, more] = std::minmax({std::abs(before), std::abs(after)});
  return more <= kBendEvenness * less ? std::abs(after - before) / std::abs(rise) : -1;
}

bool isStraightInZ(const Grid& grid) {
  size_t straight_in_z = 0, straight_in_inv_z = 0;
  const auto judge = [&](size_t a, size_t b, size_t c) {
    const std::array<float, 3> inv_z{grid.at(a), grid.at(b), grid.at(c)};
    if (!(std::min({inv_z[0], inv_z[1], inv_z[2]}) > 0)) return;
    const float bend = bendOf(inv_z[0], inv_z[1], inv_z[2]);
    const float bend_of_z = bendOf(1 / inv_z[0], 1 / inv_z[1], 1 / inv_z[2]);
    if (bend < 0 || bend_of_z < 0) return;
    if (bend_of_z < kStraighter * bend) ++straight_in_z;
    if (bend < kStraighter * bend_of_z) ++straight_in_inv_z;
  };
  for (uint32_t y = 0; y < grid.height(); ++y) {
    for (uint32_t x = 0; x < grid.width(); ++x) {
      const size_t here = grid.index(x, y);
      const size_t below = size_t{grid.width()} * kBendReach;
      if (x + 2 * kBendReach < grid.width()) judge(here, here + kBendReach, here + 2 * kBendReach);
      if (y + 2 * kBendReach < grid.height()) judge(here, here + below, here + 2 * below);
    }
  }
  return double(straight_in_z) >= kBendShare * double(grid.cellCount()) &&
         double(straight_in_z) >= kBendDominance * double(straight_in_inv_z);
}

// Share of the px of some rows that lie at the nearest depth of all.
double shareAtNearest(const DepthSamples& samples, const DepthMeasures& measures, double top,
                      double bottom) {
  const float nearest = measures.inv_z_max * 0.999F;
  const auto first = static_cast<std::ptrdiff_t>(top * samples.height_px) * samples.width_px;
  const auto last = static_cast<std::ptrdiff_t>(bottom * samples.height_px) * samples.width_px;
  if (last <= first) return 0;
  const auto count = std::count_if(samples.inv_z.begin() + first, samples.inv_z.begin() + last,
                                   [nearest](float inv_z) { return inv_z >= nearest; });
  return double(count) / double(last - first);
}

bool hasNearRim(const DepthSamples& samples) {
  const float top = medianIn(samples, {.bottom = 0.15});
  const float bottom = medianIn(samples, {.top = 0.85});
  const float left = medianIn(samples, {.right = 0.12, .bottom = 0.7});
  const float right = medianIn(samples, {.left = 0.88, .bottom = 0.7});
  const float middle = medianIn(samples, {.left = 0.3, .top = 0.3, .right = 0.7, .bottom = 0.7});
  return std::min({top, bottom, left, right, middle}) >= 0 && top > 1.1F * bottom &&
         std::min(left, right) > 1.1F * middle;
}

}  // namespace

std::string insideOutSign(const DepthSamples& samples, const DepthMeasures& measures) {
  if (measures.inv_z_max > measures.inv_z_median * 1.01F &&
      shareAtNearest(samples, measures, 0, 0.25) > 0.2 &&
      shareAtNearest(samples, measures, 0.75, 1) < 0.05) {
    return "the top of the picture is nearest, as if the sky were in front";
  }
  if (hasNearRim(samples)) {
    return "the top is nearer than the bottom, and the sides are nearer than the middle";
  }
  const Grid grid(samples);
  if (isStraightInZ(grid))
    return "floors and walls are straight in Z, but they should be straight in 1/Z";
  if (hasFarIslands(grid)) return "objects lie behind their surroundings, as if seen through holes";
  return "";
}

}  // namespace viewloom::inspect
