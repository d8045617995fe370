// SPDX-License-Identifier: Apache-2.0
#include "bench/true_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "bench/bench_scenes.h"
#include "scoring/psnr.h"
#include "synthetic/synthetic_frame.h"

namespace viewloom::bench {
namespace {

uint32_t packSrgb(const glm::vec3& srgb) {
  uint32_t rgba = 0;
  for (int i = 0; i < 3; ++i) {
    rgba |= uint32_t(std::lround(255 * std::clamp(srgb[i], 0.0F, 1.0F))) << (8 * i);
  }
  return rgba;
}

// Rays of a view, in the space of the source's camera.
class ViewRays {
 public:
  ViewRays(const Camera& view, SizePx source_px)
      : view_(view),
        source_(syntheticCamera(source_px).intrinsics),
        size_px_(source_px.width, source_px.height) {}

  // Points at planar depth 1 of the view.
  glm::dvec3 along(uint32_t x, uint32_t y) const {
    const glm::dvec2 slope =
        (glm::dvec2(x + 0.5, y + 0.5) - view_.intrinsics.principal_px) / view_.intrinsics.focal_px;
    return view_.pose.orientation * glm::dvec3(slope.x, -slope.y, -1);
  }
  // u and v of the point at this depth of the view.
  glm::dvec2 atDepth(const glm::dvec3& along, double depth_m) const {
    const glm::dvec3 point_m = view_.pose.position_m + depth_m * along;
    const glm::dvec2 slope = glm::dvec2(point_m.x, -point_m.y) / -point_m.z;
    return (source_.focal_px * slope + source_.principal_px) / size_px_;
  }
  // Place of the point at this 1/Z of the source.
  glm::dvec2 atInvZ(const glm::dvec3& along, double inv_z) const {
    return atDepth(along, (-1 / inv_z - view_.pose.position_m.z) / along.z);
  }

 private:
  const Camera& view_;
  Intrinsics source_;
  glm::dvec2 size_px_;
};

constexpr double kSky_m = 1e6;  // as good as infinitely far
constexpr uint32_t kAlpha = 0xff000000U;

// Whether the source's image has the place in it: px of others are not scored.
bool isInImage(const glm::dvec2& place) {
  return place.x >= 0 && place.x < 1 && place.y >= 0 && place.y < 1;
}

// Where the ray meets a surface whose inv_z depends on u and v so weakly that iterating converges.
template <typename Surface>
SceneSample meet(const ViewRays& rays, const glm::dvec3& along, const Surface& surface) {
  constexpr float kFirst_inv_z = 0.2F;
  // u and v change by less than 0.6 times the error of inv_z (a span of 190 px over an inv_z_max of
  // 0.33 is that part of 1080 px), and inv_z by kSmoothSlopeMax of this: 12 rounds leave less than
  // 1e-6 of the error.
  constexpr int kRounds = 12;
  SceneSample sample{kFirst_inv_z, {}};
  for (int round = 0; round < kRounds; ++round) {
    const glm::vec2 place(rays.atInvZ(along, double{sample.inv_z}));
    sample = surface(place.x, place.y);
  }
  return sample;
}

// `look`: what a ray meets.
template <typename Look>
std::vector<uint32_t> lookAround(const Camera& view, SizePx view_px, SizePx source_px,
                                 const Look& look) {
  const ViewRays rays(view, source_px);
  std::vector<uint32_t> rgba;
  rgba.reserve(view_px.area());
  for (uint32_t y = 0; y < view_px.height; ++y) {
    for (uint32_t x = 0; x < view_px.width; ++x) {
      const glm::dvec3 along = rays.along(x, y);
      const SceneSample met = look(rays, along);
      const bool is_known = isInImage(rays.atInvZ(along, double{met.inv_z}));
      rgba.push_back(packSrgb(met.srgb) | (is_known ? kAlpha : 0));
    }
  }
  return rgba;
}

}  // namespace

std::vector<uint32_t> trueClutter(const Camera& view, SizePx view_px, SizePx source_px) {
  // The renderer blends textures over a column: so many columns for one of the view that they are
  // the source's, of which one has the px's centre in its own.
  const double per_px =
      syntheticCamera(source_px).intrinsics.focal_px.x / view.intrinsics.focal_px.x;
  const auto columns = uint32_t(std::max(std::lround(per_px), 1L));
  Camera fine = view;
  fine.intrinsics.focal_px.x *= columns;
  fine.intrinsics.principal_px.x = view.intrinsics.principal_px.x * columns;
  if (columns % 2 == 0) fine.intrinsics.principal_px.x += 0.5;
  const SizePx fine_px{view_px.width * columns, view_px.height};
  const std::vector<SyntheticLayer> layers =
      renderSyntheticFrame({.size_px = fine_px, .layer_count = 1, .time_s = 0, .camera = fine});
  const SyntheticLayer& seen = layers.front();
  const ViewRays rays(view, source_px);
  std::vector<uint32_t> rgba(view_px.area());
  for (size_t px = 0; px < rgba.size(); ++px) {
    const size_t at = px * columns + columns / 2;
    const double depth_m = std::min(double{seen.depth_m[at]}, kSky_m);
    const glm::dvec3 along = rays.along(uint32_t(px % view_px.width), uint32_t(px / view_px.width));
    std::memcpy(&rgba[px], &seen.color[4 * at], sizeof(uint32_t));
    if (!isInImage(rays.atDepth(along, depth_m))) rgba[px] &= ~kAlpha;
  }
  return rgba;
}

std::vector<uint32_t> trueSmooth(const Camera& view, SizePx view_px, SizePx source_px) {
  return lookAround(view, view_px, source_px, [](const ViewRays& rays, const glm::dvec3& along) {
    return meet(rays, along, smoothAt);
  });
}

std::vector<uint32_t> trueThin(const Camera& view, SizePx view_px, SizePx source_px) {
  std::vector<Wire> nearest_first = makeWires();
  std::sort(nearest_first.begin(), nearest_first.end(),
            [](const Wire& a, const Wire& b) { return a.inv_z > b.inv_z; });
  const auto look = [&](const ViewRays& rays, const glm::dvec3& along) {
    for (const Wire& wire : nearest_first) {
      const glm::vec2 place(rays.atInvZ(along, double{wire.inv_z}));
      if (wire.covers(place.x, place.y)) return SceneSample{wire.inv_z, wire.srgb};
    }
    return meet(rays, along, [](float u, float v) { return wallAt(u, v, 0); });
  };
  return lookAround(view, view_px, source_px, look);
}

std::vector<uint32_t> meanView(const TrueView& true_view, const Camera& view, SizePx view_px) {
  Camera fine = view;
  fine.intrinsics.focal_px *= kTruePlaces;
  fine.intrinsics.principal_px *= kTruePlaces;
  const SizePx fine_px{view_px.width * kTruePlaces, view_px.height * kTruePlaces};
  const std::vector<uint32_t> places = true_view(fine, fine_px);
  constexpr uint32_t kCount = kTruePlaces * kTruePlaces;
  std::vector<uint32_t> rgba(view_px.area());
  for (size_t px = 0; px < rgba.size(); ++px) {
    std::array<uint32_t, 4> sums{};
    for (uint32_t i = 0; i < kCount; ++i) {
      const size_t row = px / view_px.width * kTruePlaces + i / kTruePlaces;
      const size_t column = px % view_px.width * kTruePlaces + i % kTruePlaces;
      const uint32_t place = places[row * fine_px.width + column];
      for (uint32_t c = 0; c < 4; ++c) sums[c] += place >> (8 * c) & 255U;
    }
    for (uint32_t c = 0; c < 3; ++c) rgba[px] |= (sums[c] + kCount / 2) / kCount << (8 * c);
    if (sums[3] == 255 * kCount) rgba[px] |= kAlpha;
  }
  return rgba;
}

TrueTiles::TrueTiles(const BenchLoad& load) : layout_(*load.job.layout) {
  if (!load.true_view) return;
  const auto count = uint32_t(layout_.views.size());
  for (const uint32_t view : {0U, count / 2, count - 1}) {
    if (!tiles_.empty() && tiles_.back().view == view) continue;
    tiles_.push_back(
        {view, meanView(load.true_view, layout_.views[view].camera, layout_.tile_size_px)});
  }
}

std::optional<double> TrueTiles::psnrDb(std::span<const uint32_t> atlas) const {
  if (tiles_.empty() || atlas.empty()) return std::nullopt;
  const SizePx tile_px = layout_.tile_size_px;
  constexpr double kPeak = 255;
  Psnr psnr;
  for (const Tile& tile : tiles_) {
    const TileOrigin origin = layout_.tileOrigin(tile.view);
    for (size_t px = 0; px < tile.rgba.size(); ++px) {
      if ((tile.rgba[px] & kAlpha) == 0) continue;
      const size_t row = origin.y_px + px / tile_px.width;
      const uint32_t got = atlas[row * layout_.size_px.width + origin.x_px + px % tile_px.width];
      for (uint32_t shift = 0; shift < 24; shift += 8) {
        const int error = int(got >> shift & 255U) - int(tile.rgba[px] >> shift & 255U);
        psnr.add(error / kPeak);
      }
    }
  }
  return psnr.db();
}

}  // namespace viewloom::bench
