// SPDX-License-Identifier: Apache-2.0
// Colour with depth as grey, and what lies behind the first surface: against the source, against
// the oracle's second crossing, and swept against walked.
#include <algorithm>
#include <cmath>

#include "display/atlas_layout.h"
#include "display/rgbd.h"
#include "gpu/judge_views.h"
#include "oracle/analytic_scenes.h"
#include "oracle/surface_behind.h"
#include "shared/histogram.h"
#include "support/test_device.h"
#include "support/test_frames.h"
#include "sweep/sweep_source.h"
#include "sweep/view_sweeper.h"

namespace viewloom::rgbd_views_test {
namespace {

constexpr double kTolerance_px = 0.05;

// The job whose views show what stands behind the first surface.
TraceJob behind(TraceJob job) {
  for (abi::ViewParams& tile : job.tiles) tile.shows = abi::kShowsBehind;
  return job;
}

oracle::OutputView movedTo(const oracle::Scene& scene, const glm::dvec3& position_m) {
  oracle::OutputView view = oracle::ownView(scene);
  view.position_m = position_m;
  return view;
}

class BehindTest : public GpuTest {
 protected:
  TraceJob jobFor(const StructureSlot& slot, const std::vector<oracle::OutputView>& views) {
    return behind(jobOf(views, kTolerance_px, slot.sourceCamera(), slot.shape().depth_px));
  }

  oracle::Verdict judge(const oracle::Scene& scene, const std::vector<oracle::OutputView>& views) {
    const std::unique_ptr<StructureSlot> slot = walk_.build(*frameOf(scene));
    const oracle::OracleSource source = sourceOf(scene, *slot);
    const std::vector<TracedView> traced = walk_.trace(*slot, jobFor(*slot, views));
    oracle::Judge judge(source, oracle::toleranceOf(source, kTolerance_px),
                        oracle::AskedSurface::kBehind);
    for (size_t i = 0; i < views.size(); ++i) {
      for (int row = 0; row < views[i].height; ++row) {
        for (int column = 0; column < views[i].width; ++column) {
          oracle::TestedAnswer tested =
              testedAnswer(traced[i].records[traced[i].index(column, row)]);
          if (isHit(tested.ray_class)) tested.ray_class = oracle::RayClass::kHit;
          judge.consider(oracle::rayOf(views[i], column + 0.5, row + 0.5), tested,
                         scene.name + " px " + std::to_string(column) + ", " + std::to_string(row));
        }
      }
    }
    return judge.verdict();
  }

  WalkUnderTest& walk_ = shared<WalkUnderTest>();
};

// Before a wall that goes on behind it, a plate fills the right half: behind its px lies the wall,
// elsewhere nothing.
const oracle::Scene kPlateBeforeWall =
    oracle::stepScene({0, 0, 1.0}, {1.0 / 4096, 0, 0.25}, 32, true, 64, 48);

TEST_F(BehindTest, isTheNextLayerFromTheSourcesOwnPlace) {
  const std::unique_ptr<StructureSlot> slot = walk_.build(*frameOf(kPlateBeforeWall));
  const TracedView traced =
      walk_.trace(*slot, jobFor(*slot, {oracle::ownView(kPlateBeforeWall)})).front();
  for (int row = 0; row < 48; ++row) {
    for (int column = 0; column < 64; ++column) {
      const abi::RayRecord& record = traced.records[traced.index(column, row)];
      EXPECT_EQ(record.layer, column < 32 ? 0u : 1u) << column;
      EXPECT_NEAR(record.inv_z, (column + 0.5) / 4096 + 0.25, 1e-6) << column;
    }
  }
}

TEST_F(BehindTest, agreesWithTheOraclesSecondCrossingFromBeside) {
  const oracle::Verdict verdict = judge(
      kPlateBeforeWall,
      {movedTo(kPlateBeforeWall, {0.1, 0.05, 0.02}), movedTo(kPlateBeforeWall, {-0.1, 0, 0})});
  EXPECT_EQ(verdict.differing, 0u) << verdict.summary();
  EXPECT_LE(verdict.excusedShare(), 0.1) << verdict.summary();
}

TEST_F(BehindTest, isTheSecondOfFourCurvedLayers) {
  const oracle::Scene scene = oracle::smoothScene(80, 60, 4);
  const oracle::Verdict verdict =
      judge(scene, {oracle::ownView(scene), movedTo(scene, {-0.08, 0.03, 0})});
  EXPECT_EQ(verdict.differing, 0u) << verdict.summary();
  EXPECT_LE(verdict.excusedShare(), 0.1) << verdict.summary();
}

// Walked on from where it hit, a ray counts as behind the layers it went through, wherever it comes
// out from behind them; and layers behind as not yet passed. The oracle follows each along the way.
TEST_F(BehindTest, agreesWithTheOracleOnScenesOfManySilhouettes) {
  oracle::Random random(21);
  oracle::Verdict sum;
  for (uint64_t seed = 0; seed < 56; ++seed) {
    sum.add(judge(oracle::randomScene(seed),
                  oracle::randomViews(random, oracle::kInPlaneKindCount, 13, 10)));
  }
  std::cout << sum.summary() << "\n";
  EXPECT_LE(double(sum.differing), 0.01 * double(sum.rays)) << sum.summary();
}

// From beside, a rough surface is met once more where it is rough: it does not stand behind itself.
TEST_F(BehindTest, isNeverTheRoughnessOfTheFirstSurface) {
  oracle::Scene scene = oracle::planeScene({1.0 / 4096, 0, 0.25}, 64, 48);
  oracle::Random random(5);
  for (float& inv_z : scene.planes.inv_z) inv_z += float(random.uniform(-1e-3, 1e-3));
  scene.kappa = {0.01f, 0};
  const std::unique_ptr<StructureSlot> slot = walk_.build(*frameOf(scene));
  const std::vector<oracle::OutputView> views = {movedTo(scene, {1.5, 0, 0})};
  const TracedView first = walk_.trace(*slot, views, kTolerance_px).front();
  const TracedView second = walk_.trace(*slot, jobFor(*slot, views)).front();
  int hit_count = 0;
  for (size_t i = 0; i < first.records.size(); ++i) {
    EXPECT_EQ(second.records[i].inv_z, first.records[i].inv_z) << i;
    hit_count += first.records[i].ray_class == abi::kClassHit;
  }
  EXPECT_GT(hit_count, 500);
}

class RgbdViewsTest : public GpuTest {
 protected:
  static constexpr SizePx kSource_px{160, 90};

  RgbdViewsTest() {
    frame_ = test::syntheticFrame(1, kSource_px, 2);
    slot_ = walk_.build(*frame_);
    source_.prepare(frame_, workers_);
  }

  TraceJob jobOf(const RgbdSpec& rgbd, RayFilter filter = {}) {
    DisplaySpec spec{.kind = rgbd, .filter = filter};
    spec = completeDisplaySpec(spec).value();
    const auto layout = std::make_shared<const AtlasLayout>(
        makeAtlasLayout(
            spec, streamDefaults(source_.camera().intrinsics, kSource_px, source_.measured().stats))
            .value());
    return makeTraceJob(layout, spec, displayPose(spec, source_.camera()), source_.camera(),
                        kSource_px);
  }

  SweptAtlas sweep(const TraceJob& job, const TraceOutputs& outputs) {
    const double inv_z_max = source_.measured().stats.inv_z_max;
    const auto plan = SweepPlan::make(job, inv_z_max);
    SweptAtlas atlas;
    if (!plan) {
      ADD_FAILURE() << "cannot be swept";
      return atlas;
    }
    std::vector<ViewSweeper> sweepers;
    sweepAtlas(
        {.job = &job, .plan = &*plan, .source = source_.rowSource(), .inv_z_max = float(inv_z_max)},
        outputs, workers_, sweepers, atlas);
    return atlas;
  }

  std::vector<uint32_t> swept(const TraceJob& job) {
    const SweptAtlas atlas = sweep(job, {});
    return {atlas.color.begin(), atlas.color.end()};
  }

  std::vector<uint32_t> walked(const TraceJob& job) {
    const SizePx size_px = job.layout->size_px;
    TraceSlot slot(device(), slotShape(job, size_px.height, {}));
    CommandRecorder recorder(device());
    Timeline timeline(device());
    ViewTracer tracer(device());
    tracer.recordBand(recorder.begin(), *slot_, job, {0, size_px.height}, slot, nullptr);
    timeline.wait(recorder.submit(timeline));
    return {slot.color().begin(), slot.color().end()};
  }

  // inv_z of the nearest layer as it was sent: from its own place, what the view sees.
  float sentInvZ(uint32_t x, uint32_t y) const {
    return source_.rowSource().columns->row(0, int(y))[x];
  }

  // The largest difference of any channel.
  static int largestStep(const std::vector<uint32_t>& a, const std::vector<uint32_t>& b) {
    EXPECT_EQ(a.size(), b.size());
    int largest = 0;
    for (size_t i = 0; i < a.size(); ++i) {
      for (const int shift : {0, 8, 16}) {
        largest =
            std::max(largest, std::abs(int(a[i] >> shift & 0xff) - int(b[i] >> shift & 0xff)));
      }
    }
    return largest;
  }

  uint32_t tilePixel(const std::vector<uint32_t>& atlas, const AtlasLayout& layout, uint32_t view,
                     uint32_t x, uint32_t y) const {
    const TileOrigin origin = layout.tileOrigin(view);
    return atlas[size_t{origin.y_px + y} * layout.size_px.width + origin.x_px + x];
  }

  WorkerPool workers_{2};
  WalkUnderTest& walk_ = shared<WalkUnderTest>();
  FramePtr frame_;
  std::unique_ptr<StructureSlot> slot_;
  SweepSource source_;
};

// The code a depth should have, in double precision.
int codeOf(double inv_z, const DepthCodes& codes) {
  const double share = (inv_z - codes.inv_z_far) / (codes.inv_z_near - codes.inv_z_far);
  const double code = std::round(std::clamp(share, 0.0, 1.0) * codes.codeMax());
  return int(codes.is_black_near ? codes.codeMax() - code : code);
}

TEST_F(RgbdViewsTest, showsTheSourcesOwnDepthSweptAndWalkedWhereverItLies) {
  for (const DepthPlacement placement : {DepthPlacement::kRight, DepthPlacement::kLeft,
                                         DepthPlacement::kTop, DepthPlacement::kBottom}) {
    for (const bool is_black_near : {false, true}) {
      RgbdSpec rgbd{.view_size_px = kSource_px};
      rgbd.depth_placement = placement;
      rgbd.is_black_near = is_black_near;
      const TraceJob job = jobOf(rgbd);
      const AtlasLayout& layout = *job.layout;
      for (const std::vector<uint32_t>& atlas : {swept(job), walked(job)}) {
        const uint32_t depth_view = layout.views[0].shows_depth ? 0 : 1;
        int wrong_count = 0;
        for (uint32_t y = 0; y < kSource_px.height; ++y) {
          for (uint32_t x = 0; x < kSource_px.width; ++x) {
            const uint32_t grey = tilePixel(atlas, layout, depth_view, x, y);
            const int expected = codeOf(double{sentInvZ(x, y)}, *layout.depth_codes);
            wrong_count += grey != (0xff000000u | uint32_t(expected) * 0x010101u);
          }
        }
        EXPECT_EQ(wrong_count, 0) << int(placement) << is_black_near;
      }
      EXPECT_LE(largestStep(swept(job), walked(job)), 1);
    }
  }
}

TEST_F(RgbdViewsTest, showsTheSecondLayerBelowTheFirst) {
  const TraceJob job = jobOf({.view_size_px = kSource_px, .form = RgbdForm::kTwoLayers});
  EXPECT_FALSE(SweepPlan::make(job, source_.measured().stats.inv_z_max).has_value());
  const AtlasLayout& layout = *job.layout;
  const std::vector<uint32_t> atlas = walked(job);
  const auto* const colors = reinterpret_cast<const uint32_t*>(frame_->sources[0][1].color->data());
  const auto* const first = reinterpret_cast<const uint32_t*>(frame_->sources[0][0].color->data());
  int wrong_count = 0, behind_count = 0;
  for (uint32_t y = 0; y < kSource_px.height; ++y) {
    for (uint32_t x = 0; x < kSource_px.width; ++x) {
      const float behind_inv_z = source_.rowSource().columns->row(1, int(y))[x];
      const float kappa = source_.measured().steps.kappa.at(sentInvZ(x, y));
      const bool is_behind = behind_inv_z >= 0 && sentInvZ(x, y) - behind_inv_z > kappa;
      const double inv_z = double{is_behind ? behind_inv_z : sentInvZ(x, y)};
      const uint32_t at = y * kSource_px.width + x;
      behind_count += is_behind;
      const uint32_t grey = uint32_t(codeOf(inv_z, *layout.depth_codes)) * 0x010101u;
      wrong_count += (tilePixel(atlas, layout, 3, x, y) & 0xffffff) != grey;
      wrong_count += (tilePixel(atlas, layout, 2, x, y) & 0xffffff) !=
                     ((is_behind ? colors : first)[at] & 0xffffff);
      wrong_count += (tilePixel(atlas, layout, 0, x, y) & 0xffffff) != (first[at] & 0xffffff);
    }
  }
  EXPECT_EQ(wrong_count, 0);
  EXPECT_GT(behind_count, 1000);
}

// Samples of a px are averaged in light; its code stays that of the ray through its middle.
TEST_F(RgbdViewsTest, keepsCodesThatAreFiltered) {
  const RgbdSpec rgbd{.view_size_px = {80, 45}};
  const TraceJob plain = jobOf(rgbd);
  const TraceJob filtered = jobOf(rgbd, {.sample_count = 4});
  const std::vector<uint32_t> one = walked(plain);
  const std::vector<uint32_t> many = walked(filtered);
  int different_count = 0;
  for (uint32_t y = 0; y < 45; ++y) {
    for (uint32_t x = 0; x < 80; ++x) {
      EXPECT_EQ(tilePixel(many, *plain.layout, 1, x, y), tilePixel(one, *plain.layout, 1, x, y));
      different_count +=
          tilePixel(many, *plain.layout, 0, x, y) != tilePixel(one, *plain.layout, 0, x, y);
    }
  }
  EXPECT_GT(different_count, 1000);
}

}  // namespace
}  // namespace viewloom::rgbd_views_test
