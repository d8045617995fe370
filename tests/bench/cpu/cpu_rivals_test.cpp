// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "bench/cpu/planar_runs.h"
#include "bench/cpu/sample_rows.h"
#ifdef VIEWLOOM_HAS_EMBREE
#include "bench/cpu/embree_mesh.h"
#endif

namespace viewloom::bench::cpu_rivals_test {
namespace {

constexpr SizePx kSource{96, 64};
constexpr uint32_t kBackground_rgb = 0x123456;
constexpr uint32_t kBackground = 0xff563412;  // red in the low byte
// A few roundings of binary32, in scenes up to 0.5 1/m that change by less than that a view.
constexpr double kInvZTolerance = 2e-6;
// Silhouettes are where rivals may differ: half a px of footprint, and half of rounding columns.
constexpr double kSilhouette_px = 1;

std::vector<std::unique_ptr<Contestant>> makeRivals() {
  std::vector<std::unique_ptr<Contestant>> rivals;
  rivals.push_back(std::make_unique<SampleRows>());
  rivals.push_back(std::make_unique<PlanarRuns>());
#ifdef VIEWLOOM_HAS_EMBREE
  rivals.push_back(std::make_unique<EmbreeMesh>());
#endif
  return rivals;
}

using InvZ = std::function<double(double x_px, double y_px)>;

Camera sourceCamera() {
  return {.intrinsics = {.focal_px = {80, 80}, .principal_px = {48, 32}}};
}

// Colours are noise: none is like its neighbour's.
void addLayer(LoadSource& source, const InvZ& inv_z) {
  std::mt19937 random(uint32_t(7 + source.inv_z.size()));
  std::vector<float>& plane = source.inv_z.emplace_back();
  std::vector<uint32_t>& colors = source.rgba.emplace_back();
  for (uint32_t y = 0; y < kSource.height; ++y) {
    for (uint32_t x = 0; x < kSource.width; ++x) {
      plane.push_back(float(inv_z(x + 0.5, y + 0.5)));
      colors.push_back(uint32_t(random()) | 0xff000000U);
      source.inv_z_max = std::max(source.inv_z_max, plane.back());
    }
  }
}

BenchLoad makeLoad(const std::vector<InvZ>& layers, uint32_t columns, uint32_t rows,
                   uint32_t scale) {
  BenchLoad load;
  load.source.size_px = kSource;
  load.source.kappa.least = 0.02F;
  for (const InvZ& layer : layers) addLayer(load.source, layer);
  const auto layout = std::make_shared<AtlasLayout>();
  layout->columns = columns;
  layout->rows = rows;
  layout->tile_size_px = {kSource.width * scale, kSource.height * scale};
  layout->padding_top_px = 3;
  layout->size_px = {columns * layout->tile_size_px.width, rows * layout->tile_size_px.height + 3};
  load.job.layout = layout;
  load.job.background_rgb = kBackground_rgb;
  return load;
}

void addView(BenchLoad& load, const Pose& pose, double scale) {
  View view{.camera = sourceCamera()};
  view.camera.pose = pose;
  view.camera.intrinsics.focal_px *= scale;
  view.camera.intrinsics.principal_px *= scale;
  load.job.tiles.push_back(makeViewParams(view, Pose{}, sourceCamera(), kSource, 0.25));
}

// Views on both sides of the source, itself in the middle; more of them than one packet of rays.
BenchLoad makeRowOfViews(const std::vector<InvZ>& layers, uint32_t scale = 1) {
  BenchLoad load = makeLoad(layers, 7, 3, scale);
  for (int view = -10; view <= 10; ++view) {
    addView(load, {.position_m = {0.03 * view, 0, 0}}, scale);
  }
  load.is_one_axis = true;
  load.disparity_span_px = 80 * 0.3 * double{load.source.inv_z_max};
  return load;
}

// One px of an atlas and its ray: at inv_z w it is at w eye + (1 - w eye.z) far.
struct Ray {
  size_t offset_px = 0;
  glm::dvec3 eye{};
  glm::dvec2 far{};

  glm::dvec2 at(double inv_z) const { return inv_z * glm::dvec2(eye) + (1 - inv_z * eye.z) * far; }
};

void forRays(const BenchLoad& load, const std::function<void(const Ray&)>& use) {
  const AtlasLayout& layout = *load.job.layout;
  for (uint32_t view = 0; view < load.job.tiles.size(); ++view) {
    const abi::ViewParams& tile = load.job.tiles[view];
    for (uint32_t y = 0; y < layout.tile_size_px.height; ++y) {
      for (uint32_t x = 0; x < layout.tile_size_px.width; ++x) {
        const glm::dvec3 direction = glm::dvec3(tile.direction) +
                                     (x + 0.5) * glm::dvec3(tile.direction_dx) +
                                     (y + 0.5) * glm::dvec3(tile.direction_dy);
        const size_t row = 3 + view / layout.columns * layout.tile_size_px.height + y;
        use({.offset_px =
                 row * layout.size_px.width + view % layout.columns * layout.tile_size_px.width + x,
             .eye = tile.eye,
             .far = glm::dvec2(direction) / direction.z});
      }
    }
  }
}

Picture makePicture(Contestant& rival, const BenchLoad& load) {
  EXPECT_TRUE(rival.takes(load));
  rival.prepare(load);
  rival.build();
  rival.build();  // a second frame of the same shape
  rival.trace();
  return rival.picture();
}

// How far inside a rectangle, px; negative outside.
double depthInside(const glm::dvec2& at, double left, double top, double right, double bottom) {
  return std::min(std::min(at.x - left, right - at.x), std::min(at.y - top, bottom - at.y));
}
double depthInImage(const glm::dvec2& at) {
  return depthInside(at, 0, 0, kSource.width, kSource.height);
}

// w = a + b x + c y over the whole image.
void expectPlane(const BenchLoad& load, const Picture& picture, double a, double b, double c) {
  size_t stray_count = 0;
  size_t false_hit_count = 0;
  forRays(load, [&](const Ray& ray) {
    const double along =
        b * (ray.eye.x - ray.eye.z * ray.far.x) + c * (ray.eye.y - ray.eye.z * ray.far.y);
    const double inv_z = (a + b * ray.far.x + c * ray.far.y) / (1 - along);
    const double inside_px = depthInImage(ray.at(inv_z));
    const float got = picture.inv_z[ray.offset_px];
    if (inside_px > kSilhouette_px) {
      stray_count += std::abs(double{got} - inv_z) <= kInvZTolerance ? 0 : 1;
    } else if (inside_px < -kSilhouette_px) {
      false_hit_count += got == kNoSurface && picture.rgba[ray.offset_px] == kBackground ? 0 : 1;
    }
  });
  EXPECT_EQ(stray_count, 0U) << "rays that do not hit where they should";
  EXPECT_EQ(false_hit_count, 0U) << "rays beside the plane that hit";
}

TEST(CpuRivals, hitASlantedPlaneWhereItIs) {
  const BenchLoad load =
      makeRowOfViews({[](double x, double y) { return 0.1 + 0.003 * x + 0.001 * y; }});
  for (const auto& rival : makeRivals()) {
    SCOPED_TRACE(rival->name());
    expectPlane(load, makePicture(*rival, load), 0.1, 0.003, 0.001);
  }
}

TEST(CpuRivals, magnify) {
  const BenchLoad load = makeRowOfViews({[](double x, double) { return 0.4 - 0.002 * x; }}, 2);
  for (const auto& rival : makeRivals()) {
    SCOPED_TRACE(rival->name());
    expectPlane(load, makePicture(*rival, load), 0.4, -0.002, 0);
  }
}

TEST(CpuRivals, takeEyesThatAreNotInARowOnlyIfTheyCan) {
  BenchLoad load =
      makeLoad({[](double x, double y) { return 0.1 + 0.003 * x + 0.001 * y; }}, 1, 1, 1);
  addView(load,
          {.position_m = {0.1, -0.2, -0.3},
           .orientation = glm::angleAxis(0.1, glm::dvec3(0.6, 0.8, 0))},
          1);
  for (const auto& rival : makeRivals()) {
    SCOPED_TRACE(rival->name());
    EXPECT_EQ(rival->takes(load), rival->name() == "embree");
    if (rival->takes(load)) expectPlane(load, makePicture(*rival, load), 0.1, 0.003, 0.001);
  }
}

// A card, 1/m, before a wall that is whole in two layers.
constexpr double kCard = 0.5;
constexpr double kWall = 0.1;
bool isCard(double x_px, double y_px) {
  return depthInside({x_px, y_px}, 40, 20, 60, 50) > 0;
}
BenchLoad makeCardBeforeWall() {
  return makeRowOfViews({[](double x, double y) { return isCard(x, y) ? kCard : kWall; },
                         [](double x, double y) { return isCard(x, y) ? kWall : kNoSurface; }});
}

TEST(CpuRivals, seeACardBeforeAWallFromAllSides) {
  const BenchLoad load = makeCardBeforeWall();
  for (const auto& rival : makeRivals()) {
    SCOPED_TRACE(rival->name());
    const Picture picture = makePicture(*rival, load);
    size_t wrong_count = 0;
    forRays(load, [&](const Ray& ray) {
      const double on_card_px = depthInside(ray.at(kCard), 40, 20, 60, 50);
      const double on_wall_px = depthInImage(ray.at(kWall));
      if (std::min(std::abs(on_card_px), std::abs(on_wall_px)) < kSilhouette_px) return;
      const double inv_z = on_card_px > 0 ? kCard : on_wall_px > 0 ? kWall : double{kNoSurface};
      wrong_count +=
          std::abs(double{picture.inv_z[ray.offset_px]} - inv_z) <= kInvZTolerance ? 0 : 1;
    });
    EXPECT_EQ(wrong_count, 0U);
  }
}

TEST(CpuRivals, returnTheSourceFromItsOwnPose) {
  const BenchLoad load = makeCardBeforeWall();
  for (const auto& rival : makeRivals()) {
    SCOPED_TRACE(rival->name());
    const Picture picture = makePicture(*rival, load);
    size_t wrong_count = 0;
    size_t sample = 0;
    forRays(load, [&](const Ray& ray) {
      if (ray.eye.x != 0) return;
      wrong_count += picture.rgba[ray.offset_px] == load.source.rgba[0][sample] ? 0 : 1;
      wrong_count +=
          std::abs(picture.inv_z[ray.offset_px] - load.source.inv_z[0][sample]) <= kInvZTolerance
              ? 0
              : 1;
      ++sample;
    });
    EXPECT_EQ(sample, kSource.area());
    EXPECT_EQ(wrong_count, 0U);
  }
}

TEST(CpuRivals, keepALoneSample) {
  const BenchLoad load = makeRowOfViews(
      {[](double x, double y) { return x == 30.5 && y == 10.5 ? 0.25 : double{kNoSurface}; }});
  for (const auto& rival : makeRivals()) {
    SCOPED_TRACE(rival->name());
    const Picture picture = makePicture(*rival, load);
    size_t wrong_count = 0;
    forRays(load, [&](const Ray& ray) {
      const double on_sample_px = depthInside(ray.at(0.25), 30, 10, 31, 11);
      if (std::abs(on_sample_px) < 0.01) return;  // its very edge
      const bool is_hit = picture.inv_z[ray.offset_px] != kNoSurface;
      wrong_count += is_hit == (on_sample_px > 0) ? 0 : 1;
      const uint32_t color = load.source.rgba[0][10 * kSource.width + 30];
      wrong_count += picture.rgba[ray.offset_px] == (is_hit ? color : kBackground) ? 0 : 1;
    });
    EXPECT_EQ(wrong_count, 0U);
  }
}

}  // namespace
}  // namespace viewloom::bench::cpu_rivals_test
