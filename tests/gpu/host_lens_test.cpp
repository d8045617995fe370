// SPDX-License-Identifier: Apache-2.0
// A lens that the CPU gathers, beside rays that the device walks one by one.
#include "lens/band_gatherer.h"

#include "gpu/built_structure.h"
#include "gpu/through_lens.h"
#include "picture/display_sources.h"

namespace viewloom::host_lens_test {
namespace {

class HostLens : public ThroughLens {
 protected:
  void SetUp() override {
    ThroughLens::SetUp();
    if (IsSkipped()) return;
    if (!device().info().is_software) GTEST_SKIP() << "the device gathers: it is not the CPU";
  }

  static DisplaySpec withLens(decltype(DisplaySpec::kind) kind) {
    DisplaySpec spec{.kind = std::move(kind)};
    spec.lens = walkedLens();
    return spec;
  }

  // 8 + 32 rays, gathered, and 8 walked ones, beside 64 walked ones; codes, root mean square.
  void expectNearerThanFew(DisplaySpec spec, double share, uint32_t layer_count = 2) {
    const FramePtr frame = test::syntheticFrame(1, kSource_px, layer_count);
    renderer_->build(*frame);
    const RenderedAtlas few = render(spec);
    spec.lens->walked_count = 64;
    const RenderedAtlas many = render(spec);
    spec.lens->walked_count = kWalked;
    spec.lens->gathered_count = 32;
    const RenderedAtlas gathered = render(spec);
    renderer_ = &rendererAt(GatheringPlace::kDevice);
    renderer_->build(*frame);
    EXPECT_NE(gathered.color, render(spec).color) << "it was the device that gathered";
    const double few_codes = differenceOf(few, many);
    const double gathered_codes = differenceOf(gathered, many);
    std::cout << "rms " << few_codes << " codes of few rays, " << gathered_codes << " gathered\n";
    EXPECT_LT(gathered_codes, share * few_codes);
  }
};

// Noise of 8 independent rays beside 40: alone it would be sqrt(8 / 40) = 0.45; with rays spread
// evenly it is less.
constexpr double kNoiseShare = 0.5;
// Where much is hidden, what is assumed differs, too.
constexpr double kAssumedShare = 0.7;

TEST_F(HostLens, looksAsManyRaysFromTheSourcesPlace) {
  ViewCamera camera;
  camera.projection = Fov{-0.25, 0.25, 0.15, -0.15};
  expectNearerThanFew(withLens(CamerasSpec{.cameras = {camera}, .tile_size_px = {320, 192}}),
                      kNoiseShare);
}

TEST_F(HostLens, looksAsManyRaysInAQuilt) {
  expectNearerThanFew(
      withLens(QuiltSpec{.columns = 3, .rows = 2, .size_px = {484, 262}, .view_cone_rad = 0.3}),
      kAssumedShare);
}

TEST_F(HostLens, looksAsManyRaysWhereAViewIsTurnedAndHasSteppedForward) {
  ViewCamera camera;
  camera.pose.position_m = {0.05, -0.02, -0.3};
  camera.pose.orientation = glm::angleAxis(0.15, glm::normalize(glm::dvec3(0.3, 1, 2)));
  camera.projection = Fov{-0.2, 0.15, 0.12, -0.12};
  expectNearerThanFew(
      withLens(CamerasSpec{.cameras = {camera}, .tile_size_px = {160, 120}, .columns = 1}),
      kAssumedShare);
}

// For a single layer, where much is hidden and shown by few rays anyway.
TEST_F(HostLens, looksAsManyRaysFarBesideTheSource) {
  expectNearerThanFew(
      withLens(QuiltSpec{.columns = 2, .rows = 1, .size_px = {420, 280}, .view_cone_rad = 0.6}), 1,
      1);
}

// A px whose middle ray ends hidden shows its walked rays.
TEST_F(HostLens, showsWalkedRaysWhereTheMiddleOneEndsHidden) {
  renderer_->build(*test::syntheticFrame(1, kSource_px, 1));
  DisplaySpec spec =
      withLens(QuiltSpec{.columns = 2, .rows = 1, .size_px = {420, 280}, .view_cone_rad = 0.6});
  const RenderedAtlas walked = render(spec);
  spec.lens->gathered_count = 32;
  const RenderedAtlas gathered = render(spec);
  size_t hidden_count = 0;
  size_t differing = 0;
  for (size_t px = 0; px < gathered.color.size(); ++px) {
    if (gathered.mask[px] != abi::kClassHidden) continue;
    ++hidden_count;
    for (int c = 0; c < 3; ++c) {
      const int apart = channelOf(gathered.color[px], c) - channelOf(walked.color[px], c);
      differing += std::abs(apart) > kCodeTolerance;
    }
  }
  std::cout << hidden_count << " px are hidden, " << differing << " channels differ\n";
  EXPECT_GT(hidden_count, 1000U);
  EXPECT_LE(double(differing), kTiedShareMax * 3 * double(hidden_count));
}

// Whoever gathers which rows, and however many at once.
TEST_F(HostLens, isTheSameInPieces) {
  DisplaySpec spec =
      withLens(QuiltSpec{.columns = 2, .rows = 3, .size_px = {220, 211}, .view_cone_rad = 0.2});
  spec.lens->gathered_count = 8;
  const auto completed = completeDisplaySpec(spec);
  ASSERT_TRUE(completed.ok()) << completed.status();
  const BuiltFrame built(device(), shared<StructureBuilder>(),
                         test::syntheticFrame(1, kSource_px, 2));
  const FrameStructure& structure = built.structure;
  const SeenSource seen = seenSource(built.source());
  const auto layout = makeAtlasLayout(
      *completed,
      streamDefaults(built.source().camera.intrinsics, kSource_px, structure.stats().front()));
  ASSERT_TRUE(layout.ok()) << layout.status();
  const auto shared = std::make_shared<AtlasLayout>(*layout);
  TraceJob job = makeTraceJob(shared, *completed, Pose{}, std::span(&seen, 1));
  job.gathers_on_host = gathersOnHost(isInReach(device(), structure.firstPart().shape()), job);
  ASSERT_TRUE(job.gathers_on_host);

  const HostStructure host = hostStructure(structure.firstPart());
  const size_t width_px = shared->size_px.width;
  const std::vector<uint32_t> middle(shared->size_px.area(), 0xff808080);
  const auto gatheredIn = [&](uint32_t row_count) {
    std::vector<uint32_t> color = middle;
    BandGatherer gatherer;
    for (uint32_t row = 0; row < shared->size_px.height; row += row_count) {
      const uint32_t count = std::min(row_count, shared->size_px.height - row);
      gatherer.gather(host, job,
                      {.piece = {{row, count}, 0, shared->size_px.width},
                       .color = std::span(color).subspan(row * width_px, count * width_px),
                       .linear = {}});
    }
    return color;
  };
  const std::vector<uint32_t> whole = gatheredIn(shared->size_px.height);
  EXPECT_NE(whole, middle);
  EXPECT_EQ(gatheredIn(8), whole);
  EXPECT_EQ(gatheredIn(13), whole);
  // All px once, in pieces of a strip.
  for (const uint64_t ray_count : {uint64_t{1}, uint64_t{20'000}, UINT64_MAX}) {
    std::vector<uint32_t> counts(shared->size_px.area(), 0);
    std::vector<uint32_t> color = middle;
    BandGatherer gatherer;
    for (const GatheredPiece& piece :
         gatheredPieces(*shared, {0, shared->size_px.height}, ray_count)) {
      const uint32_t end_row = piece.rows.first_row + piece.rows.row_count;
      for (size_t row = piece.rows.first_row; row < end_row; ++row) {
        for (size_t x = piece.first_column; x < piece.end_column; ++x) ++counts[row * width_px + x];
      }
      gatherer.gather(host, job,
                      {.piece = piece,
                       .color = std::span(color).subspan(piece.rows.first_row * width_px,
                                                         piece.rows.row_count * width_px),
                       .linear = {}});
    }
    EXPECT_EQ(std::ranges::count(counts, 1U), ptrdiff_t(counts.size()));
    EXPECT_EQ(color, whole) << ray_count;
  }
}

// A row of blocks of a wide atlas takes long with many points.
TEST(GatheredPieces, haveBoundedWorkHoweverWideAnAtlasIs) {
  AtlasLayout layout{.size_px = {16384, 64}, .tile_size_px = {16384, 64}};
  layout.lens = LensRays{.walked_count = kWalkedSamplesMax, .gathered_count = kGatheredSamplesMax};
  constexpr uint64_t kRays = 100'000;
  for (const GatheredPiece& piece : gatheredPieces(layout, {0, 64}, kRays)) {
    const uint64_t px = uint64_t{piece.rows.row_count} * (piece.end_column - piece.first_column);
    EXPECT_LE(px * layout.lens->pointCount(), kRays);
  }
}

}  // namespace
}  // namespace viewloom::host_lens_test
