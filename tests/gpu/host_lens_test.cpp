// SPDX-License-Identifier: Apache-2.0
// A lens that the CPU gathers, beside rays that the device walks one by one.
#include "lens/band_gatherer.h"

#include <random>

#include "gpu/through_lens.h"
#include "lens/host_structure.h"
#include "lens/sheet_list.h"
#include "trace/display_sources.h"

namespace viewloom {
namespace {

// The synthetic frame, built.
struct BuiltFrame {
  explicit BuiltFrame(const Device& device, SizePx size_px = kSource_px, uint32_t layer_count = 2)
      : frame(test::syntheticFrame(1, size_px, layer_count)), structure(device, shapesOf(*frame)) {
    structure.upload(*frame);
    StructureBuilder builder(device);
    Timeline timeline(device);
    CommandRecorder recorder(device);
    structure.recordBuild(recorder.begin(), builder);
    timeline.wait(recorder.submit(timeline));
  }

  const SourceFormat& source() const { return frame->format.sources.front(); }

  FramePtr frame;
  FrameStructure structure;
};

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
    renderer_.emplace(device(), GatheringPlace::kDevice);
    renderer_->build(*frame);
    EXPECT_NE(gathered.color, render(spec).color) << "it was the device that gathered";
    const double few_codes = differenceOf(few, many);
    const double gathered_codes = differenceOf(gathered, many);
    std::cout << "rms " << few_codes << " codes of few rays, " << gathered_codes << " gathered\n";
    EXPECT_LT(gathered_codes, share * few_codes);
  }
};

// Of 8 independent rays beside 40, noise alone would be sqrt(8 / 40) = 0.45; evenly spread as they
// are, it is less.
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

// Of a single layer, where much is hidden and shown by few rays anyway.
TEST_F(HostLens, looksAsManyRaysFarBesideTheSource) {
  expectNearerThanFew(
      withLens(QuiltSpec{.columns = 2, .rows = 1, .size_px = {420, 280}, .view_cone_rad = 0.6}), 1,
      1);
}

// Whoever gathers which rows, and however many at once.
TEST_F(HostLens, isTheSameInPieces) {
  DisplaySpec spec =
      withLens(QuiltSpec{.columns = 2, .rows = 3, .size_px = {220, 211}, .view_cone_rad = 0.2});
  spec.lens->gathered_count = 8;
  const auto completed = completeDisplaySpec(spec);
  ASSERT_TRUE(completed.ok()) << completed.status();
  const BuiltFrame built(device());
  const FrameStructure& structure = built.structure;
  const SeenSource seen = seenSource(built.source());
  const auto layout = makeAtlasLayout(
      *completed,
      streamDefaults(built.source().camera.intrinsics, kSource_px, structure.stats().front()));
  ASSERT_TRUE(layout.ok()) << layout.status();
  const auto shared = std::make_shared<AtlasLayout>(*layout);
  TraceJob job = makeTraceJob(shared, *completed, Pose{}, std::span(&seen, 1));
  settleGathering(isInReach(device(), structure.firstPart().shape()), job);
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
                      {.rows = {row, count},
                       .color = std::span(color).subspan(row * width_px, count * width_px),
                       .linear = {}});
    }
    return color;
  };
  const std::vector<uint32_t> whole = gatheredIn(shared->size_px.height);
  EXPECT_NE(whole, middle);
  EXPECT_EQ(gatheredIn(8), whole);
  EXPECT_EQ(gatheredIn(13), whole);
  // As those do it who gather a strip: all rows, once.
  uint32_t row = 0;
  while (row < shared->size_px.height) {
    const BandRows rest = {row, shared->size_px.height - row};
    const BandRows piece = firstGathered(*shared, rest);
    EXPECT_EQ(piece.first_row, row);
    ASSERT_GT(piece.row_count, 0u);
    row += piece.row_count;
  }
  EXPECT_EQ(row, shared->size_px.height);
}

// A ray of a view that looks as the source does, from beside it.
struct StraightRay {
  glm::vec2 far{0};   // where its 1/Z is 0, px of the source
  glm::vec2 pace{0};  // and how that moves for each 1/m
};

// What the ray passes through first, found by small steps through the facets.
struct Passed {
  uint32_t layer = 0;
  glm::vec2 place{0};
  float inv_z = 0;
};

std::optional<Passed> firstPassed(const HostStructure& host, const StraightRay& ray) {
  constexpr int kSteps = 4000;
  std::array<bool, abi::kLayerCountMax> in_front{};
  glm::ivec2 cell_before(-1);
  for (int step = kSteps; step >= 0; --step) {
    const float inv_z = host.inv_z_max * 1.001F * float(step) / kSteps;
    const glm::vec2 place = ray.far + inv_z * ray.pace;
    const glm::ivec2 cell(glm::floor(place));
    const bool is_inside = cell.x >= 0 && cell.y >= 0 && cell.x < int(host.size_px.width) &&
                           cell.y < int(host.size_px.height);
    for (uint32_t layer = 0; is_inside && layer < host.layer_count; ++layer) {
      const SurfaceCell facet = surfaceCell(host, layer, abi::kLevelFacets, glm::uvec2(cell));
      const float surface = facet.is_plane ? facet.at(place - glm::vec2(cell) - 0.5F) : -1.0F;
      const bool is_in_front = inv_z > surface;
      if (cell == cell_before && in_front[layer] && !is_in_front) return {{layer, place, surface}};
      in_front[layer] = is_in_front;
    }
    cell_before = is_inside ? cell : glm::ivec2(-1);
  }
  return std::nullopt;
}

bool isListed(const SheetList& list, const Passed& passed) {
  return std::ranges::any_of(list.sheets(), [&](const abi::MetSheet& sheet) {
    const float off = glm::dot(sheet.plane, glm::vec3(passed.place, 1)) - passed.inv_z;
    return sheet.layer == passed.layer && std::abs(off) <= 2 * list.reach();
  });
}

// From a place beside the source, m.
void expectListsWhateverRaysMeet(const BuiltFrame& built, glm::vec2 eye_m) {
  const HostStructure host = hostStructure(built.structure.firstPart());
  const float focal_px = float(built.source().camera.intrinsics.focal_px.x);
  constexpr float kStep_px = 2;  // of the source, for a px of the view
  abi::ViewParams view{};
  view.eye = {focal_px * eye_m, 0};
  view.direction = {0, 0, 1};
  view.direction_dx = {kStep_px, 0, 0};
  view.direction_dy = {0, kStep_px, 0};
  view.lens_px_m = glm::vec2(0.02F * focal_px / kStep_px);
  view.lens_inv_focus = 0.5F;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1);
  SheetList list;
  uint32_t met_count = 0;
  uint32_t missing_count = 0;
  uint32_t settled_count = 0;
  for (uint32_t block = 0; block < 220; ++block) {
    const glm::vec2 low(block % 20 * 8, block / 20 * 8);
    list.find(host, view, low, low + 8.0F);
    settled_count += list.isSettled();
    for (int i = 0; i < 16; ++i) {
      const glm::vec2 px = low + 8.0F * glm::vec2(unit(random), unit(random));
      const float angle = 6.2831853F * unit(random);
      const float radius_px_m = view.lens_px_m.x * std::sqrt(unit(random));
      const glm::vec2 moved = radius_px_m * glm::vec2(std::cos(angle), std::sin(angle));
      const auto passed = firstPassed(host, {.far = kStep_px * (px - view.lens_inv_focus * moved),
                                             .pace = glm::vec2(view.eye) + kStep_px * moved});
      met_count += passed.has_value();
      missing_count += passed && !isListed(list, *passed);
    }
  }
  std::cout << met_count << " met, " << missing_count << " of them missing; " << settled_count
            << " blocks settled\n";
  EXPECT_GT(met_count, 2000U);
  EXPECT_GT(settled_count, 20U);
  EXPECT_EQ(missing_count, 0U);
}

TEST_F(HostLens, listsWhateverRaysMeet) {
  expectListsWhateverRaysMeet(BuiltFrame(device()), {0.06, -0.03});
}

// There a quarter of a px is less than planes of the structure are off by, and bodies are met edge
// on.
TEST_F(HostLens, listsWhateverRaysMeetFarBesideTheSource) {
  expectListsWhateverRaysMeet(BuiltFrame(device(), {640, 360}, 1), {0.6, 0});
}

}  // namespace
}  // namespace viewloom
