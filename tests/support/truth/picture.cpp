// SPDX-License-Identifier: Apache-2.0
#include "support/truth/picture.h"

#include <array>
#include <cmath>

namespace viewloom::truth {
namespace {

// A Fibonacci lattice: no two of the places share a row or a column, so that also an edge along
// an axis is found to within 1/21 px.
constexpr uint32_t kPlaces = 21;
constexpr uint32_t kPlaceStep = 13;

glm::dvec2 placeInPixel(uint32_t i) {
  return {(i + 0.5) / kPlaces, ((i * kPlaceStep) % kPlaces + 0.5) / kPlaces};
}

class PixelEye {
 public:
  PixelEye(const Instant& instant, const PictureOptions& options, Picture& picture)
      : instant_(instant), options_(options), picture_(picture) {}

  void look(uint32_t x, uint32_t y) {
    const Ray ray = rayThrough(picture_.camera, {x + 0.5, y + 0.5});
    const HitColumn column = instant_.peel(ray, options_.layer_count);
    const size_t px = size_t{y} * picture_.size_px.width + x;
    for (uint32_t layer = 0; layer < column.count; ++layer) {
      const Hit& hit = column.hits[layer];
      PictureLayer& planes = picture_.layers[layer];
      planes.color[px] = instant_.color(ray, hit);
      planes.depth_m[px] = static_cast<float>(hit.depth);
      planes.normal[px] = hit.normal;
      planes.motion_mps[px] = instant_.motion_mps(ray, hit);
      planes.body[px] = hit.body;
      planes.gloss[px] = instant_.gloss(hit);
    }
    if (options_.color == ColorOver::kArea) averageColors({x, y}, px, column.count);
  }

 private:
  // Averages the layers that have something at the px's centre.
  void averageColors(const glm::dvec2& corner_px, size_t px, uint32_t layer_count) {
    std::array<glm::vec3, kLayersMax> sums{};
    std::array<uint32_t, kLayersMax> counts{};
    for (uint32_t i = 0; i < kPlaces; ++i) {
      const Ray ray = rayThrough(picture_.camera, corner_px + placeInPixel(i));
      const HitColumn column = instant_.peel(ray, options_.layer_count);
      for (uint32_t layer = 0; layer < layer_count; ++layer) {
        PictureLayer& planes = picture_.layers[layer];
        const Hit* const own = column.find(planes.body[px]);
        const Hit* const first = column.count > 0 ? column.hits.data() : nullptr;
        const Hit* const seen = layer == 0 ? first : own;
        if (layer == 0 && (seen == nullptr || seen != own)) planes.is_mixed[px] = 1;
        if (seen == nullptr) continue;
        sums[layer] += instant_.color(ray, *seen);
        ++counts[layer];
      }
    }
    for (uint32_t layer = 0; layer < layer_count; ++layer) {
      if (counts[layer] == 0) continue;  // thinner than the lattice: its colour at the centre
      picture_.layers[layer].color[px] = sums[layer] / static_cast<float>(counts[layer]);
    }
  }

  const Instant& instant_;
  const PictureOptions& options_;
  Picture& picture_;
};

}  // namespace

Ray rayThrough(const Camera& camera, const glm::dvec2& at_px) {
  const glm::dvec2 slope = (at_px - camera.intrinsics.principal_px) / camera.intrinsics.focal_px;
  return {camera.pose.position_m, camera.pose.orientation * glm::dvec3(slope.x, -slope.y, -1.0)};
}

Picture takePicture(const Instant& instant, const Camera& camera, const PictureOptions& options) {
  Picture picture{.camera = camera, .size_px = options.size_px, .layers = {}};
  picture.layers.resize(options.layer_count);
  const size_t area_px = options.size_px.area();
  for (PictureLayer& layer : picture.layers) {
    layer.color.resize(area_px);
    layer.depth_m.resize(area_px);
    layer.normal.resize(area_px);
    layer.motion_mps.resize(area_px);
    layer.gloss.resize(area_px);
    layer.body.resize(area_px, kNoBody);
    layer.is_mixed.resize(area_px);
  }
  PixelEye eye(instant, options, picture);
  for (uint32_t y = 0; y < options.size_px.height; ++y) {
    for (uint32_t x = 0; x < options.size_px.width; ++x) eye.look(x, y);
  }
  return picture;
}

}  // namespace viewloom::truth
