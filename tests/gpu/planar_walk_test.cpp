// SPDX-License-Identifier: Apache-2.0
// Atlases that the walk stores as Y'CbCr are judged by the same atlas in RGB and libjpeg-turbo's
// conversion.
#include <algorithm>

#include "gpu/walk_under_test.h"
#include "oracle/scene_generator.h"
#include "support/test_device.h"
#include "support/test_frames.h"
#include "support/ycbcr_planes.h"

namespace viewloom::planar_walk_test {
namespace {

constexpr SizePx kSource_px{160, 90};
constexpr uint32_t kBandRows = 128;

// Atlases of 4x2 tiles: whole vectors and others, paddings, odd heights, more than one band.
constexpr SizePx kAtlases_px[] = {{416, 264}, {421, 265}, {33, 131}, {4, 3}, {255, 388}};

DisplaySpec quilt(SizePx size_px) {
  DisplaySpec spec = test::smallQuilt();
  std::get<QuiltSpec>(spec.kind) = {.columns = 4, .rows = 2, .size_px = size_px, .view_count = 7};
  spec = completeDisplaySpec(spec).value();
  spec.outside_fill = OutsideFill::kBackground;
  spec.background_rgb = 0xE04080;
  return spec;
}

// The same from elsewhere: rays of a view are no longer those of a row.
DisplaySpec turned(DisplaySpec spec) {
  spec.world_pose = Pose{.position_m = {0.3, 0.1, -0.4},
                         .orientation = glm::normalize(glm::dquat(0.98, 0.1, 0.15, 0.05))};
  return spec;
}

class PlanarWalkTest : public GpuTest {
 protected:
  PlanarWalkTest() : recorder_(device()), timeline_(device()) {}

  void build(const Frame& frame) { structure_ = walk_.build(frame); }

  TraceJob jobOf(const DisplaySpec& spec) const {
    const Camera& camera = structure_->sourceCamera();
    const StreamDefaults defaults{.source_intrinsics = camera.intrinsics,
                                  .source_size_px = structure_->shape().depth_px,
                                  .focal_distance_m = contentFocalDistance(structure_->stats())};
    const auto layout =
        std::make_shared<const AtlasLayout>(makeAtlasLayout(spec, defaults).value());
    return makeTraceJob(layout, spec, displayPose(spec, camera), camera,
                        structure_->shape().depth_px);
  }

  void trace(const TraceJob& job, BandRows rows, TraceSlot& slot) {
    tracer_.recordBand(recorder_.begin(), *structure_, job, rows, slot, nullptr);
    timeline_.wait(recorder_.submit(timeline_));
  }

  TraceSlot slotFor(const TraceJob& job, const TraceOutputs& outputs) const {
    return {device(),
            {.width_px = job.layout->size_px.width + 64,
             .row_count_max = kBandRows,
             .tile_count_max = uint32_t(job.tiles.size()),
             .outputs = outputs}};
  }

  // Band by band, in slots that are reused.
  void expectTheSamePicture(const DisplaySpec& spec, ColorForm form) {
    const TraceJob job = jobOf(spec);
    const SizePx size_px = job.layout->size_px;
    TraceSlot rgb = slotFor(job, {.mask = true});
    TraceSlot planar = slotFor(job, {.color = form, .depth = true, .mask = true});
    for (uint32_t row = 0; row < size_px.height; row += kBandRows) {
      SCOPED_TRACE(testing::Message() << size_px.width << "x" << size_px.height << " from row "
                                      << row << ", form " << int(form));
      const BandRows rows = {row, std::min(kBandRows, size_px.height - row)};
      trace(job, rows, rgb);
      trace(job, rows, planar);
      const SizePx band_px = {size_px.width, rows.row_count};
      EXPECT_TRUE(
          std::ranges::equal(planar.ycbcr(), test::ycbcrPlanesOf(rgb.color(), band_px, form)));
      EXPECT_TRUE(std::ranges::equal(planar.mask(), rgb.mask()));
      EXPECT_EQ(planar.coverage(), rgb.coverage());
      EXPECT_TRUE(planar.color().empty() && rgb.ycbcr().empty());
    }
  }

  WalkUnderTest& walk_ = shared<WalkUnderTest>();
  ViewTracer& tracer_ = shared<ViewTracer>();
  CommandRecorder recorder_;
  Timeline timeline_;
  std::unique_ptr<StructureSlot> structure_;
};

TEST_F(PlanarWalkTest, storesThePlanesOfTheAtlas) {
  build(*test::syntheticFrame(1, kSource_px, 2));
  for (const SizePx size_px : kAtlases_px) {
    expectTheSamePicture(quilt(size_px), ColorForm::kYcbcr420);
    expectTheSamePicture(quilt(size_px), ColorForm::kYcbcr444);
  }
  expectTheSamePicture(turned(quilt({416, 264})), ColorForm::kYcbcr420);
}

TEST_F(PlanarWalkTest, storesThePlanesOfWhatIsSemitransparent) {
  const oracle::Scene scene = oracle::randomScene(11, 64, 48, 2);
  build(*frameOf(scene, {{0.4F, 0.1F, 0.05F, 0.5F}, {0.1F, 0.6F, 0.9F, 1.0F}}));
  expectTheSamePicture(quilt({416, 264}), ColorForm::kYcbcr420);
  expectTheSamePicture(quilt({416, 264}), ColorForm::kYcbcr444);
}

}  // namespace
}  // namespace viewloom::planar_walk_test
