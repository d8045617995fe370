// SPDX-License-Identifier: Apache-2.0
#include "picture/trace_job.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "base/check.h"
#include "display/ray_extent.h"
#include "frame/cube_map.h"
#include "picture/lens_bounds.h"

namespace viewloom {
namespace {

// An eye at the source's own place sees no error in inv_z: any plane will do.
constexpr double kInvZToleranceMax = 1e30;

// Camera space (y up, looking along -z) to homogeneous image px (y down): px * Z, px * Z, Z.
glm::dvec3 homogeneousPx(const Intrinsics& intrinsics, const glm::dvec3& point_m) {
  const double depth_m = -point_m.z;
  return {intrinsics.focal_px.x * point_m.x + intrinsics.principal_px.x * depth_m,
          -intrinsics.focal_px.y * point_m.y + intrinsics.principal_px.y * depth_m, depth_m};
}

double largestCross(const glm::dvec3& eye_m, const Intrinsics& intrinsics, SizePx size_px) {
  double largest = 0;
  for (const double x_px : {0.0, double(size_px.width)}) {
    for (const double y_px : {0.0, double(size_px.height)}) {
      const glm::dvec3 ray((x_px - intrinsics.principal_px.x) / intrinsics.focal_px.x,
                           -(y_px - intrinsics.principal_px.y) / intrinsics.focal_px.y, -1.0);
      largest = std::max(largest, glm::length(glm::cross(ray, eye_m)));
    }
  }
  return largest;
}

// Directions are linear over a tile, and so are both sides of each condition: corners decide.
bool isPlainTile(const abi::ViewParams& tile, SizePx tile_px, float inv_z_near) {
  const abi::vec3 near_eye = tile.eye * inv_z_near;
  if (!(near_eye.z < 1)) return false;
  for (const float x_px : {0.0F, float(tile_px.width)}) {
    for (const float y_px : {0.0F, float(tile_px.height)}) {
      const abi::vec3 direction =
          tile.direction + x_px * tile.direction_dx + y_px * tile.direction_dy;
      const float extent_max = abi::kPlainExtentMax_px * direction.z;
      const bool is_plain =
          direction.z > 0 &&
          std::abs(direction.x * near_eye.z - near_eye.x * direction.z) < extent_max &&
          std::abs(direction.y * near_eye.z - near_eye.y * direction.z) < extent_max;
      if (!is_plain) return false;
    }
  }
  return true;
}

// A structure that views look at.
struct SeenWalk {
  Camera camera;
  SizePx size_px;
};

// Adds the tiles with which all views see it, each pixel from the place of its sample.
void addTiles(TraceJob& job, const Pose& display_pose, const SeenWalk& seen,
              const RaySample& sample) {
  const AtlasLayout& layout = *job.layout;
  for (uint32_t row = 0; row < layout.rows; ++row) {
    for (uint32_t column = 0; column < layout.columns; ++column) {
      const uint32_t index = layout.viewAt(column, row);
      if (index >= layout.views.size()) {
        job.tiles.push_back(abi::ViewParams{});
        continue;
      }
      // Depth has no mean: all samples of it are that without a filter.
      View sampled = layout.views[index];
      if (!sampled.shows_depth) {
        sampled.camera = sampledCamera(sampled.camera, sample, layout.focusOf(sampled));
      }
      job.tiles.push_back(
          makeViewParams(sampled, display_pose, seen.camera, seen.size_px, job.tolerance_px));
      if (job.hasLens() && !sampled.shows_depth) {
        addLens(job, display_pose, seen.camera, seen.size_px, sampled, job.tiles.back());
      }
      // An error that moves nothing would still be seen in the codes.
      if (layout.depth_codes) job.tiles.back().inv_z_tolerance = 0;
    }
  }
}

abi::EyeAxes makeEyeAxes(const TraceJob& job, const Pose& display_pose, const Camera& camera) {
  const Pose source_from_view =
      compose(inverse(camera.pose), compose(display_pose, job.layout->views.front().camera.pose));
  const auto axis = [&](double x, double y) {
    return abi::vec3(
        homogeneousPx(camera.intrinsics, source_from_view.orientation * glm::dvec3(x, y, 0)));
  };
  return {.right = axis(1, 0), .up = axis(0, 1), .inv_focus = float(1 / job.layout->eye_focus_m)};
}

// The tolerance of every tile is what the outermost eye asks for.
void addBounds(TraceJob& job, const Pose& display_pose, const SeenWalk& seen) {
  const RayExtent extent = rayExtent(*job.layout);
  RayBounds bounds{.eye_axes = makeEyeAxes(job, display_pose, seen.camera),
                   .extent = {},
                   .extent_px = extent.size_px};
  float tolerance = float(kInvZToleranceMax);
  const auto include = [&](const Camera& camera) {
    bounds.extent.push_back(
        makeViewParams({camera}, display_pose, seen.camera, seen.size_px, job.tolerance_px));
    tolerance = std::min(tolerance, bounds.extent.back().inv_z_tolerance);
  };
  for (const Camera& corner : extent.corners) {
    include(corner);
    if (!job.hasLens()) continue;
    for (const glm::dvec2 of_lens : kLensCorners) {
      include(fromLensCorner(corner, *job.layout, of_lens));
    }
  }
  const auto walk = uint32_t(job.bounds.size());
  const size_t count = job.tileCount();
  for (uint32_t sample = 0; sample < job.sample_count; ++sample) {
    abi::ViewParams* const tiles = &job.tiles[(size_t{sample} * job.walk_count + walk) * count];
    for (size_t i = 0; i < count; ++i) tiles[i].inv_z_tolerance = tolerance;
  }
  job.bounds.push_back(std::move(bounds));
}

std::vector<SeenWalk> seenWalks(std::span<const SeenSource> sources) {
  std::vector<SeenWalk> walks;
  for (const SeenSource& source : sources) {
    if (!source.is_cube_map) {
      walks.push_back({source.camera, source.size_px});
      continue;
    }
    const uint32_t side_px = source.size_px.width;
    const uint32_t whole_px = side_px + 2 * abi::kCubeApron_px;
    for (uint32_t face = 0; face < kCubeFaceCount; ++face) {
      walks.push_back({cubeFaceCamera(source.camera.pose, face, side_px, abi::kCubeApron_px),
                       {whole_px, whole_px}});
    }
  }
  return walks;
}

}  // namespace

bool haveMirrors(std::span<const SeenSource> sources) {
  return std::any_of(sources.begin(), sources.end(),
                     [](const SeenSource& source) { return source.mirrors; });
}

SeenSource seenSource(const SourceFormat& source) {
  const SizePx plane_px = source.layers.front().depth.size_px;
  return {.camera = source.camera,
          .size_px = source.is_cube_map ? cubeFaceSize(plane_px) : plane_px,
          .is_cube_map = source.is_cube_map,
          .mirrors = source.mirrors(),
          .is_see_through = std::any_of(
              source.layers.begin(), source.layers.end(),
              [](const auto& layer) { return layer.color.alpha != AlphaMode::kOpaque; })};
}

TileRays raysOf(const TraceJob& job, uint32_t walk, uint32_t sample) {
  if (!job.hasEyesBeside() && job.hasLens()) {
    const size_t count = job.lens_bounds.size() / job.walk_count;
    return {std::span(job.lens_bounds).subspan(walk * count, count), job.layout->tile_size_px,
            true};
  }
  if (!job.hasEyesBeside()) return {job.tilesOf(walk, sample), job.layout->tile_size_px};
  return {job.bounds[walk].extent, job.bounds[walk].extent_px, true};
}

abi::uvec2 packFirstWalks(const TraceJob& job) {
  VIEWLOOM_CHECK(job.sources.size() <= kMergedSourcesMax && job.walk_count <= 64);
  uint32_t words[2] = {};
  for (size_t i = 0; i < job.sources.size(); ++i) {
    words[i / 4] |= job.sources[i].first_walk << (8 * (i % 4));
  }
  return {words[0], words[1]};
}

bool eyesAreInPlane(std::span<const abi::ViewParams> tiles, double inv_z_max) {
  // Poses that ought to cancel leave a few roundings. An eye so close to the plane, in units of the
  // nearest depth, moves no ray by more than 2^-16 px, kPlainExtentMax_px times as much.
  constexpr double kInPlaneMax = 0x1p-30;
  return std::all_of(tiles.begin(), tiles.end(), [&](const abi::ViewParams& tile) {
    return tile.is_used == 0 || std::abs(tile.eye.z * inv_z_max) <= kInPlaneMax;
  });
}

bool raysArePlain(std::span<const abi::ViewParams> tiles, SizePx tile_px, double inv_z_max) {
  const float inv_z_near = std::max(float(inv_z_max), abi::kInvZNearMin) * abi::kInvZNearMargin;
  return std::all_of(tiles.begin(), tiles.end(), [&](const abi::ViewParams& tile) {
    return tile.is_used == 0 || isPlainTile(tile, tile_px, inv_z_near);
  });
}

Pose displayPose(const DisplaySpec& spec, const Camera& source_camera) {
  return spec.world_pose.value_or(source_camera.pose);
}

abi::ViewParams makeViewParams(const View& view, const Pose& display_pose,
                               const Camera& source_camera, SizePx source_px, double tolerance_px) {
  const Pose source_from_view =
      compose(inverse(source_camera.pose), compose(display_pose, view.camera.pose));
  const Intrinsics& in = source_camera.intrinsics;
  const Intrinsics& out = view.camera.intrinsics;
  // A step of one metre along the view's axis, so that s is the depth in the view.
  const auto direction = [&](double x, double y, double z) {
    return abi::vec3(homogeneousPx(in, source_from_view.orientation * glm::dvec3(x, y, z)));
  };
  const double moved_px = std::max(out.focal_px.x, out.focal_px.y) *
                          largestCross(source_from_view.position_m, in, source_px);
  return {.eye = abi::vec3(homogeneousPx(in, source_from_view.position_m)),
          .direction = direction(-out.principal_px.x / out.focal_px.x,
                                 out.principal_px.y / out.focal_px.y, -1.0),
          .direction_dx = direction(1.0 / out.focal_px.x, 0.0, 0.0),
          .direction_dy = direction(0.0, -1.0 / out.focal_px.y, 0.0),
          .inv_z_tolerance =
              float(std::min(tolerance_px / std::max(moved_px, 1e-300), kInvZToleranceMax)),
          .is_used = 1,
          .shows =
              (view.shows_depth ? abi::kShowsDepth : 0) | (view.is_behind ? abi::kShowsBehind : 0)};
}

TraceJob makeTraceJob(std::shared_ptr<const AtlasLayout> layout, const DisplaySpec& spec,
                      const Pose& display_pose, std::span<const SeenSource> sources) {
  TraceJob job;
  job.layout = std::move(layout);
  job.tolerance_px = spec.tolerance_px;
  job.outside_fill = spec.outside_fill;
  job.background_rgb = spec.background_rgb;
  job.reflection = spec.reflection;
  aimTraceJob(job, display_pose, sources);
  return job;
}

TraceJob makeTraceJob(std::shared_ptr<const AtlasLayout> layout, const DisplaySpec& spec,
                      const Pose& display_pose, const Camera& source_camera, SizePx source_px) {
  const SeenSource source{source_camera, source_px};
  return makeTraceJob(std::move(layout), spec, display_pose, std::span(&source, 1));
}

void aimTraceJob(TraceJob& job, const Pose& display_pose, std::span<const SeenSource> sources) {
  job.sources.clear();
  job.walk_count = 0;
  job.has_mirrors = haveMirrors(sources);
  for (const SeenSource& source : sources) {
    const uint32_t walk_count = source.is_cube_map ? kCubeFaceCount : 1;
    job.sources.push_back({.first_walk = job.walk_count, .walk_count = walk_count});
    job.walk_count += walk_count;
  }
  const AtlasLayout& layout = *job.layout;
  const std::vector<SeenWalk> walks = seenWalks(sources);
  job.source_poses.clear();
  for (const SeenWalk& walk : walks) job.source_poses.push_back(walk.camera.pose);
  job.sample_count = uint32_t(layout.samples.size());
  job.tiles.clear();
  job.tiles.reserve(size_t{job.sample_count} * job.walk_count * layout.columns * layout.rows);
  for (const RaySample& sample : layout.samples) {
    for (const SeenWalk& walk : walks) addTiles(job, display_pose, walk, sample);
  }
  job.bounds.clear();
  job.lens_bounds.clear();
  if (std::holds_alternative<PinholeRays>(layout.rays)) {
    if (!job.hasLens()) return;
    for (const SeenWalk& walk : walks) {
      addLensBounds(job, display_pose, walk.camera, walk.size_px);
    }
    return;
  }
  for (const SeenWalk& walk : walks) addBounds(job, display_pose, walk);
}

}  // namespace viewloom
