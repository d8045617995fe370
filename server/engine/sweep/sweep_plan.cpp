// SPDX-License-Identifier: Apache-2.0
#include "sweep/sweep_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace viewloom {
namespace {

// Poses that ought to cancel leave a few roundings. Positions in the source may be off by this
// much, a quarter of a step of colour.
constexpr double kMoved_px = 1.0 / (4 * kSubtexelSteps);

bool canSweep(const abi::ViewParams& tile, SizePx tile_px, double inv_z_max) {
  if ((tile.shows & abi::kShowsBehind) != 0) return false;
  if (!(tile.direction.z > 0) || !(tile.direction_dx.x > 0)) return false;
  const double z = double{tile.direction.z};
  const double across = tile_px.width;
  const double down = tile_px.height;
  const auto isSmall = [](double moved_px) { return std::abs(moved_px) <= kMoved_px; };
  // A direction off by this share of its depth moves the picture by up to a side of it.
  const auto isSmallShare = [&](double share) {
    return std::abs(share) * abi::kPlainExtentMax_px <= kMoved_px;
  };
  return isSmall(tile.eye.y * inv_z_max) && isSmallShare(tile.eye.z * inv_z_max) &&
         isSmall(tile.direction_dx.y * across / z) && isSmall(tile.direction_dy.x * down / z) &&
         isSmallShare(tile.direction_dx.z * across / z) &&
         isSmallShare(tile.direction_dy.z * down / z);
}

// The line of a panel's eyes runs along the rows of the source.
bool staysInRows(const TraceJob& job, const LensPieces& pieces, double inv_z_max) {
  const abi::EyeAxes& axes = job.bounds.front().eye_axes;
  const double reach_inv_z =
      double{pieces.pxPerInvZ()} / std::abs(double{axes.right.x}) * inv_z_max;
  return std::abs(axes.right.y * reach_inv_z) <= kMoved_px &&
         std::abs(axes.right.z * reach_inv_z) * abi::kPlainExtentMax_px <= kMoved_px;
}

}  // namespace

std::optional<SweepPlan> SweepPlan::make(const TraceJob& job, double inv_z_max) {
  if (job.walk_count != 1 || job.hasLens() || job.reflects()) return std::nullopt;
  std::optional<LensPieces> lens_pieces = LensPieces::make(job, inv_z_max);
  if (job.hasEyesBeside() && !(lens_pieces && staysInRows(job, *lens_pieces, inv_z_max))) {
    return std::nullopt;
  }
  const SizePx tile_px = job.layout->tile_size_px;
  const bool is_swept = std::all_of(job.tiles.begin(), job.tiles.end(), [&](const auto& tile) {
    return tile.is_used == 0 || canSweep(tile, tile_px, inv_z_max);
  });
  if (!is_swept) return std::nullopt;
  SweepPlan plan;
  plan.tile_height_ = tile_px.height;
  plan.lens_pieces_ = std::move(lens_pieces);
  const TileRays rays = raysOf(job, 0, 0);
  plan.color_reach_ = viewloom::colorReach(rays.tiles, rays.tile_px);
  for (uint32_t sample = 0; sample < job.sample_count; ++sample) {
    plan.groups_.emplace_back();
    plan.views_.emplace_back();
    const std::span<const abi::ViewParams> tiles = job.tilesOf(0, sample);
    for (uint32_t index = 0; index < tiles.size(); ++index) {
      const abi::ViewParams& tile = tiles[index];
      plan.views_.back().push_back(tile.is_used == 0 ? OneEye{} : eyeOf(tile));
      if (tile.is_used != 0) plan.addTile(index, tile);
    }
  }
  plan.group_count_ = uint32_t(plan.groups_.front().size());
  // Groups that differ from sample to sample by rounding cannot be added up row by row.
  const auto isAlike = [&](const std::vector<SweptTiles>& groups) {
    return std::equal(groups.begin(), groups.end(), plan.groups_.front().begin(),
                      plan.groups_.front().end(),
                      [](const SweptTiles& a, const SweptTiles& b) { return a.tiles == b.tiles; });
  };
  if (!std::all_of(plan.groups_.begin(), plan.groups_.end(), isAlike)) return std::nullopt;
  return plan;
}

SweepPlan::OneEye SweepPlan::eyeOf(const abi::ViewParams& tile) {
  const double z = double{tile.direction.z};
  const double step_px = double{tile.direction_dx.x} / z;
  return {.start_px = float(double{tile.direction.x} / z + 0.5 * step_px),
          .step_px = float(step_px),
          .eye_px_m = tile.eye.x};
}

// To the last of the samples.
void SweepPlan::addTile(uint32_t index, const abi::ViewParams& tile) {
  std::vector<SweptTiles>& groups = groups_.back();
  const double z = double{tile.direction.z};
  const double step_px = double{tile.direction_dy.y} / z;
  const double first_px = double{tile.direction.y} / z + 0.5 * step_px;
  auto group = std::find_if(groups.begin(), groups.end(), [&](const SweptTiles& known) {
    return known.first_px == first_px && known.step_px == step_px;
  });
  if (group == groups.end()) {
    group = groups.insert(
        group, {.first_px = first_px, .step_px = step_px, .tolerance = tile.inv_z_tolerance});
  }
  group->tolerance = std::min(group->tolerance, tile.inv_z_tolerance);
  const float px_per_inv_z = lens_pieces_ ? lens_pieces_->pxPerInvZ() : std::abs(tile.eye.x);
  group->px_per_inv_z = std::max(group->px_per_inv_z, px_per_inv_z);
  group->tiles.push_back(index);
}

}  // namespace viewloom
