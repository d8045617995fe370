// SPDX-License-Identifier: Apache-2.0
// Which kernels a picture needs is known before anything of it is recorded: exactly those that its
// recording asks for. So are those that build a frame.
#include <gtest/gtest.h>

#include <cstring>
#include <optional>

#include "gpu/submission.h"
#include "structure/frame_structure.h"
#include "support/test_device.h"
#include "support/test_frames.h"
#include "trace/view_tracer.h"

namespace viewloom::missing_kernels_test {
namespace {

constexpr SizePx kSource_px{64, 48};
constexpr SizePx kTile_px{32, 24};

FramePtr mirroring(const Frame& frame) {
  auto mirrors = std::make_shared<Frame>(frame);
  for (size_t source = 0; source < mirrors->sources.size(); ++source) {
    for (size_t layer = 0; layer < mirrors->sources[source].size(); ++layer) {
      LayerFormat& format = mirrors->format.sources[source].layers[layer];
      const SizePx size_px = format.depth.size_px;
      format.others = {{.kind = PlaneKind::kSpecular, .size_px = size_px, .depth = {}}};
      std::vector<uint8_t> bytes(size_px.area() * sizeof(abi::SurfaceTexel), 0xff);
      mirrors->sources[source][layer].surface =
          std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
    }
  }
  return mirrors;
}

DisplaySpec complete(DisplaySpec spec) {
  return completeDisplaySpec(spec).value();
}

struct NamedDisplay {
  const char* name;
  DisplaySpec spec;
};

std::vector<NamedDisplay> displays() {
  const Pose beside{.position_m = {0.02, 0.03, 0.05}};
  const Fov fov{.left_rad = -0.4, .right_rad = 0.4, .up_rad = 0.3, .down_rad = -0.3};
  const QuiltSpec quilt{.columns = 4, .rows = 2, .size_px = {4 * 16, 2 * 12}};
  const StereoSpec eyes{.eye_size_px = kSource_px};
  const CamerasSpec cameras{
      .cameras = {{.pose = beside, .projection = fov}}, .tile_size_px = kTile_px, .columns = 1};
  const IntegralSpec integral{
      .panel_px = {64, 48}, .pixel_pitch_m = 1e-4, .lens_pitch_m = 1e-3, .focal_length_m = 3e-3};
  const LensSpec lens{.aperture_radius_m = 0.03, .focus_distance_m = 2};
  LensSpec walked = lens;
  walked.walked_count = 4;
  walked.gathered_count = 0;
  LensSpec exact = lens;
  exact.is_exact = true;
  const ReflectionSpec reflection{.bounce_count = 1, .sample_count = 1};
  return {
      {"quilt", {.kind = quilt}},
      {"quilt in the world", {.kind = quilt, .world_pose = beside}},
      {"stereo", {.kind = eyes}},
      {"cameras", {.kind = cameras}},
      {"integral", {.kind = integral}},
      {"lens", {.kind = quilt, .lens = lens}},
      {"walked lens", {.kind = quilt, .lens = walked}},
      {"exact lens in the world", {.kind = eyes, .world_pose = beside, .lens = exact}},
      {"reflections", {.kind = eyes, .reflection = reflection}},
      {"reflections through a lens", {.kind = quilt, .reflection = reflection, .lens = walked}}};
}

class MissingKernelsTest : public GpuTest {
 protected:
  // For how long compiled kernels are kept. With those of each display alone, all that a display
  // needs is asked for. With those of all displays, what the ones before it compiled is not asked
  // for again, which takes a third of the time.
  enum class Kept { kForEachDisplay, kForAllDisplays };

  // Asks for every display of these frames.
  void expectExact(const FramePtr& frame, Kept kept) {
    Timeline timeline(device());
    CommandRecorder recorder(device());
    const StructureBuilder builder(device());
    FrameStructure structure(device(), shapesOf(*frame));
    structure.upload(*frame);
    structure.recordBuild(recorder.begin(), builder);
    timeline.wait(recorder.submit(timeline));
    // By turns, so that the device gathers and the host does, with each set of planes.
    TraceOutputs planes{.color = ColorForm::kYcbcr420};
    TraceOutputs others{.depth = true, .mask = true, .linear = true};
    std::optional<Tracers> tracers;
    const auto expect = [&](const TraceJob& job) {
      if (!tracers || kept == Kept::kForEachDisplay) tracers.emplace();
      tracers->expectExact(structure, job, planes);
    };
    for (const NamedDisplay& display : displays()) {
      SCOPED_TRACE(testing::Message() << display.name << (planes.depth ? ", all planes" : ""));
      TraceJob job = jobOf(*frame, structure, display.spec);
      expect(job);
      std::swap(planes, others);
      if (!job.hasSecondStage()) continue;
      SCOPED_TRACE("the host gathers its lens");
      job.gathers_on_host = true;
      expect(job);
    }
  }

  // Asks for a build of this frame, by builders that have built none.
  void expectExactBuild(const FramePtr& frame) {
    FrameStructure structure(device(), shapesOf(*frame));
    structure.upload(*frame);
    CommandRecorder recorder(device());  // recorded, and never submitted
    const StructureBuilder told(device());
    const uint64_t before = device().kernelCount();
    MissingKernels missing;
    told.addMissing(*frame, missing);
    for (const auto& [place, compile] : missing) compile();
    const uint64_t told_count = compiledSince(before);
    EXPECT_GT(told_count, 0u);
    MissingKernels left;
    told.addMissing(*frame, left);
    EXPECT_TRUE(left.empty());
    structure.recordBuild(recorder.begin(), told);
    EXPECT_EQ(compiledSince(before), told_count)
        << "a build needed kernels that it had not told of";
    const StructureBuilder surprised(device());
    const uint64_t before_surprise = device().kernelCount();
    structure.recordBuild(CommandRecorder(device()).begin(), surprised);
    EXPECT_EQ(compiledSince(before_surprise), told_count)
        << "kernels that nobody needs were told of";
  }

 private:
  static TraceJob jobOf(const Frame& frame, const FrameStructure& structure,
                        const DisplaySpec& wanted) {
    std::vector<SeenSource> sources;
    for (const SourceFormat& source : frame.format.sources) sources.push_back(seenSource(source));
    const DisplaySpec spec = complete(wanted);
    const Camera& camera = sources.front().camera;
    auto layout = makeAtlasLayout(spec, streamDefaults(camera.intrinsics, sources.front().size_px,
                                                       structure.stats().front()));
    return makeTraceJob(std::make_shared<AtlasLayout>(layout.value()), spec,
                        displayPose(spec, camera), sources);
  }

  static uint64_t compiledSince(uint64_t before) { return device().kernelCount() - before; }

  static void record(ViewTracer& tracer, const FrameStructure& structure, const TraceJob& job,
                     const TraceOutputs& planes) {
    const BandRows rows{0, job.layout->size_px.height};
    TraceSlot slot(device(), slotShape(job, rows.row_count, planes));
    CommandRecorder recorder(device());  // recorded, and never submitted
    tracer.recordBand(recorder.begin(), structure.parts(), job, rows, slot, nullptr);
  }

  // Two that have compiled the same: one is told what is missing, the other finds out.
  struct Tracers {
    ViewTracer told{device()};
    ViewTracer surprised{device()};

    void expectExact(const FrameStructure& structure, const TraceJob& job,
                     const TraceOutputs& planes) {
      const uint64_t before = device().kernelCount();
      for (const auto& [place, compile] : told.missing(structure.parts(), job, planes)) compile();
      const uint64_t told_count = compiledSince(before);
      EXPECT_TRUE(told.missing(structure.parts(), job, planes).empty());
      record(told, structure, job, planes);
      EXPECT_EQ(compiledSince(before), told_count)
          << "recording needed kernels that nobody had told of";
      const uint64_t before_surprise = device().kernelCount();
      record(surprised, structure, job, planes);
      EXPECT_EQ(compiledSince(before_surprise), told_count)
          << "kernels were told of that nobody needs";
    }
  };
};

TEST_F(MissingKernelsTest, ofBuilds) {
  for (uint32_t layer_count = 1; layer_count <= 2; ++layer_count) {
    expectExactBuild(test::syntheticFrame(1, kSource_px, layer_count));
  }
  expectExactBuild(test::syntheticFrameFrom(1, {0, 0.2}, kSource_px));
  expectExactBuild(test::syntheticCubeFrame(1, 32));
}

TEST_F(MissingKernelsTest, ofBuildsThatAreLikely) {
  const StructureBuilder builder(device());
  for (const MissingKernels& kernels : builder.likelyKernels()) {
    for (const auto& [place, compile] : kernels) compile();
  }
  MissingKernels missing;
  for (uint32_t layer_count = 1; layer_count <= 2; ++layer_count) {
    builder.addMissing(*test::syntheticFrame(1, kSource_px, layer_count), missing);
  }
  EXPECT_TRUE(missing.empty());
}

TEST_F(MissingKernelsTest, ofOneSource) {
  expectExact(mirroring(*test::syntheticFrame(1, kSource_px, 2)), Kept::kForEachDisplay);
}

TEST_F(MissingKernelsTest, ofSeveralSources) {
  expectExact(mirroring(*test::syntheticFrameFrom(1, {0, 0.2}, kSource_px)), Kept::kForAllDisplays);
}

TEST_F(MissingKernelsTest, ofACubeMap) {
  expectExact(test::syntheticCubeFrame(1, 32), Kept::kForAllDisplays);
}

}  // namespace
}  // namespace viewloom::missing_kernels_test
