// SPDX-License-Identifier: Apache-2.0
// The rivals answer as their definition says; else beating them would be worth nothing.
#include "bench/gpu/gpu_rivals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "bench/gpu/copy_contestant.h"
#include "bench/gpu/test_loads.h"
#include "gpu/commands.h"
#include "gpu/walk_under_test.h"
#include "oracle/analytic_scenes.h"
#include "structure/structure_layout.h"
#include "support/test_device.h"

namespace viewloom::bench::gpu_rivals_test {
namespace {

constexpr int kWidth = 72;
constexpr int kHeight = 24;

Picture pictureOf(Contestant& contestant, const BenchLoad& load) {
  EXPECT_TRUE(contestant.takes(load));
  contestant.prepare(load);
  contestant.build();
  contestant.trace();
  return contestant.picture();
}

// Index of px (x, y) of a view, for a load of views side by side.
size_t indexOf(const BenchLoad& load, size_t view, int x, int y) {
  const AtlasLayout& layout = *load.job.layout;
  return size_t(y) * layout.size_px.width + view * layout.tile_size_px.width + size_t(x);
}

// Walks that state what they hit.
class GpuWalkTest : public GpuTest {
 protected:
  static std::vector<std::unique_ptr<Contestant>> walks() {
    std::vector<std::unique_ptr<Contestant>> made;
    made.push_back(makeDda(device()));
    made.push_back(makeHiZ(device()));
    return made;
  }
};

// A sample is constant over its px, and a ray may be bridged from one to the next: so the ray's
// inv_z is up to 1.5 steps of the plane away from it, along the steepest ray twice as much.
double toleranceOf(const oracle::ImagePlane& plane) {
  return 3 * (std::abs(plane.along_x) + std::abs(plane.along_y));
}

TEST_F(GpuWalkTest, meetsASlantedPlaneWhereItIs) {
  const oracle::ImagePlane plane{0x1p-9, -0x1p-10, 0.5};
  oracle::Scene scene = oracle::planeScene(plane, kWidth, kHeight);
  scene.kappa = {0.02F, 0};
  for (const int view_count : {6, 3}) {  // lanes are views, lanes are px
    const auto views = viewsBeside(scene, view_count, -0.2, 0.08);
    const BenchLoad load = loadOf(scene, views);
    for (const auto& walk : walks()) {
      const Picture picture = pictureOf(*walk, load);
      int checked_count = 0;
      for (size_t view = 0; view < views.size(); ++view) {
        for (int i = 0; i < kWidth * kHeight; ++i) {
          const int x = i % kWidth, y = i / kWidth;
          const auto point =
              oracle::meet(plane, scene.pinhole, rayOf(views[view], x + 0.5, y + 0.5).ray);
          if (!point) continue;
          const glm::dvec3 expected = oracle::imageOf(scene.pinhole, *point);
          if (expected.x < 2 || expected.x > kWidth - 2) continue;
          ++checked_count;
          EXPECT_NEAR(picture.inv_z[indexOf(load, view, x, y)], expected.z, toleranceOf(plane))
              << walk->name() << " view " << view << " px " << x << ", " << y;
        }
      }
      EXPECT_GT(checked_count, view_count * kWidth * kHeight / 2);
    }
  }
}

// Near the left end a rectangle, behind it and beside it a far plane.
TEST_F(GpuWalkTest, seesALayerBehindANearOneAndBesideIt) {
  constexpr int kFirstNear = 30;
  constexpr double kMargin_px = 2;  // from silhouettes
  const oracle::ImagePlane near{0, 0, 1}, far{0, 0, 0.25};
  oracle::Scene scene = oracle::stepScene(near, far, kFirstNear, true, kWidth, kHeight);
  scene.kappa = {0.004F, 0};
  const auto views = viewsBeside(scene, 6, -0.2, 0.08);
  const BenchLoad load = loadOf(scene, views);
  for (const auto& walk : walks()) {
    const Picture picture = pictureOf(*walk, load);
    int near_count = 0, behind_count = 0, beside_count = 0;
    for (size_t view = 0; view < views.size(); ++view) {
      for (int i = 0; i < kWidth * kHeight; ++i) {
        const int x = i % kWidth, y = i / kWidth;
        const oracle::Ray ray = rayOf(views[view], x + 0.5, y + 0.5).ray;
        const double near_x = oracle::imageOf(scene.pinhole, *meet(near, scene.pinhole, ray)).x;
        const double far_x = oracle::imageOf(scene.pinhole, *meet(far, scene.pinhole, ray)).x;
        const auto is_inside = [](double x_px) { return x_px > 1 && x_px < kWidth - 1; };
        if (std::abs(near_x - kFirstNear) < kMargin_px || !is_inside(near_x) || !is_inside(far_x)) {
          continue;
        }
        const bool is_near = near_x > kFirstNear;
        near_count += is_near;
        behind_count += !is_near && far_x > kFirstNear;
        beside_count += !is_near && far_x < kFirstNear;
        EXPECT_NEAR(picture.inv_z[indexOf(load, view, x, y)], is_near ? 1 : 0.25, 1e-5)
            << walk->name() << " view " << view << " px " << x << ", " << y;
      }
    }
    EXPECT_GT(near_count, 1000);
    EXPECT_GT(behind_count, 50);
    EXPECT_GT(beside_count, 1000);
  }
}

TEST_F(GpuWalkTest, returnsTheSourceFromItsOwnPose) {
  const oracle::Scene scene = oracle::randomScene(11, kWidth, kHeight, 2);
  const BenchLoad load = loadOf(scene, {oracle::ownView(scene)});
  for (const auto& walk : walks()) {
    const Picture picture = pictureOf(*walk, load);
    for (size_t i = 0; i < picture.rgba.size(); ++i) {
      if (load.source.inv_z[0][i] < 0) continue;
      EXPECT_EQ(picture.rgba[i], load.source.rgba[0][i]) << walk->name() << " px " << i;
      EXPECT_NEAR(picture.inv_z[i], load.source.inv_z[0][i], load.source.inv_z_max * 1e-6);
    }
  }
}

double sharePct(size_t count, size_t total) {
  return 100.0 * double(count) / double(total);
}

TEST_F(GpuWalkTest, findsTheSameByStepsAndByBoxes) {
  size_t ray_count = 0, hit_count = 0, equal_count = 0;
  oracle::Random random(3);
  for (uint64_t seed = 20; seed < 28; ++seed) {
    const oracle::Scene scene =
        oracle::randomScene(seed, 60 + 90 * int(seed % 2), 60, 1 + int(seed % 4));
    const auto views = oracle::randomViews(random, oracle::kInPlaneKindCount, 40, 30);
    const BenchLoad load = loadOf(scene, views);
    const Picture by_steps = pictureOf(*makeDda(device()), load);
    const Picture by_boxes = pictureOf(*makeHiZ(device()), load);
    const float rounding = load.source.inv_z_max * 1e-5F;
    for (size_t i = 0; i < by_steps.inv_z.size(); ++i) {
      ++ray_count;
      hit_count += by_steps.inv_z[i] != kNoSurface;
      equal_count += std::abs(by_steps.inv_z[i] - by_boxes.inv_z[i]) <= rounding;
    }
  }
  EXPECT_GE(sharePct(equal_count, ray_count), 99.9);
  EXPECT_GE(sharePct(hit_count, ray_count), 40);
}

class FloorTest : public GpuTest {
 protected:
  // Px next to a silhouette but one, in its row, or that see nothing: their colour is not that of
  // their hit alone.
  static bool isNearEdge(const Picture& picture, size_t at, float inv_z_max) {
    const size_t first = at < 2 ? 0 : at - 2;
    const auto begin = picture.inv_z.begin() + ptrdiff_t(first);
    const auto end = picture.inv_z.begin() + ptrdiff_t(std::min(at + 3, picture.inv_z.size()));
    const auto [least, most] = std::minmax_element(begin, end);
    return *least < 0 || *most - *least > 0.01F * inv_z_max;
  }
};

// Hits on an edge are taken by the px on one of its sides, which may be the other one; a blend
// there may then be rounded otherwise.
TEST_F(FloorTest, showsWhatViewloomShows) {
  const oracle::Scene scene = oracle::randomScene(5, 150, 90, 2);
  const BenchLoad load = loadOf(scene, viewsBeside(scene, 6, -0.05, 0.02));
  const Picture picture = pictureOf(*makeFloor(device()), load);

  WalkUnderTest walk(device());
  const auto structure = walk.build(*load.frame);
  const SizePx atlas_px = load.job.layout->size_px;
  TraceSlot traced(device(), {.width_px = atlas_px.width,
                              .row_count_max = atlas_px.height,
                              .tile_count_max = uint32_t(load.job.tiles.size())});
  Timeline timeline(device());
  CommandRecorder recorder(device());
  ViewTracer tracer(device());
  tracer.recordBand(recorder.begin(), *structure, load.job, {0, atlas_px.height}, traced, nullptr);
  timeline.wait(recorder.submit(timeline));
  size_t equal_count = 0;
  size_t inner_count = 0;
  for (size_t i = 0; i < atlas_px.area(); ++i) {
    if (isNearEdge(picture, i, load.source.inv_z_max)) continue;
    ++inner_count;
    equal_count += picture.rgba[i] == traced.color()[i];
  }
  EXPECT_GE(sharePct(equal_count, inner_count), 99.9);
  EXPECT_GE(sharePct(inner_count, atlas_px.area()), 50);
}

class CopyTest : public GpuTest {
 protected:
  static std::vector<std::array<uint32_t, 4>> read(const Device& device, const Buffer& buffer) {
    const Buffer readback(device, {.size_bytes = buffer.sizeBytes(),
                                   .intent = MemoryIntent::kReadback,
                                   .debug_name = "copy readback"});
    Timeline timeline(device);
    CommandRecorder recorder(device);
    const Commands commands = recorder.begin();
    recordComputeToTransfer(commands);
    commands.copy(buffer, readback, {.size_bytes = buffer.sizeBytes()});
    recordTransferToHost(commands);
    timeline.wait(recorder.submit(timeline));
    std::vector<std::array<uint32_t, 4>> units(buffer.sizeBytes() / 16);
    std::memcpy(units.data(), readback.mapped().data(), units.size() * 16);
    return units;
  }
};

TEST_F(CopyTest, fillsItsOutputWithItsInput) {
  const oracle::Scene scene = oracle::randomScene(5, 150, 90, 2);
  const BenchLoad load = loadOf(scene, {oracle::ownView(scene)});
  const Device small_bindings({.validation = true, .storage_bytes_max = 1u << 17});
  for (const Device* on : {&device(), &small_bindings}) {
    CopyContestant copy(*on);
    copy.prepare(load);
    copy.build();
    const auto from = read(*on, copy.from());
    const auto to = read(*on, copy.to());
    const CopyShape& shape = copy.shape();
    EXPECT_EQ(shape.part_count > 1, on == &small_bindings);
    ASSERT_EQ(from.size(), shape.read_count);
    ASSERT_EQ(to.size(), size_t{shape.part_count} * shape.part_written_count);
    EXPECT_GE(to.size() * 16, structureLayout(load.source.size_px).layerBytes() * 2);
    for (size_t i = 0; i < to.size(); ++i) {
      const size_t first = i / shape.part_written_count * shape.part_read_count;
      const size_t count = std::min<size_t>(shape.part_read_count, from.size() - first);
      ASSERT_EQ(to[i], from[first + i % shape.part_written_count % count]) << i;
    }
  }
  EXPECT_EQ(small_bindings.validationLog().messageCount(), 0u);
}

}  // namespace
}  // namespace viewloom::bench::gpu_rivals_test
