// SPDX-License-Identifier: Apache-2.0
// Sheets that rays through a lens may meet, as the CPU lists them, and the answer of rays that meet
// none.
#include "lens/sheet_list.h"

#include <cmath>
#include <iostream>
#include <optional>
#include <random>

#include "gpu/built_structure.h"
#include "lens/host_structure.h"
#include "lens/open_rays.h"
#include "support/test_device.h"

namespace viewloom::lens_list_test {
namespace {

constexpr SizePx kSource_px{320, 180};

class LensList : public GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (IsSkipped()) return;
    if (!device().info().is_software) GTEST_SKIP() << "the device gathers: it is not the CPU";
  }

  BuiltFrame synthetic(SizePx size_px, uint32_t layer_count) {
    return BuiltFrame(device(), shared<StructureBuilder>(),
                      test::syntheticFrame(1, size_px, layer_count));
  }
};

// A ray of a view that looks as the source does, from beside it.
struct StraightRay {
  glm::vec2 far{0};   // where its 1/Z is 0, px of the source
  glm::vec2 pace{0};  // and how that moves for each 1/m
};

// First surface that the ray passes through, found by small steps through the facets.
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
    return sheet.layer == passed.layer && std::abs(off) <= 2 * sheet.reach;
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

TEST_F(LensList, listsWhateverRaysMeet) {
  expectListsWhateverRaysMeet(synthetic(kSource_px, 2), {0.06, -0.03});
}

// There an eighth of a px is less than planes of the structure are off by, and bodies are met edge
// on.
TEST_F(LensList, listsWhateverRaysMeetFarBesideTheSource) {
  expectListsWhateverRaysMeet(synthetic({640, 360}, 1), {0.6, 0});
}

// A board before a wall, over some columns of every row.
constexpr uint32_t kBoardFirst_px = 100;
constexpr uint32_t kBoardEnd_px = 140;

FramePtr boardFrame() {
  SyntheticLayer layer;
  layer.color.assign(4 * kSource_px.area(), 200);
  for (uint32_t px = 0; px < kSource_px.area(); ++px) {
    const uint32_t x = px % kSource_px.width;
    layer.depth_m.push_back(x >= kBoardFirst_px && x < kBoardEnd_px ? 1 : 4);
  }
  const Camera camera{.pose = {},
                      .intrinsics = {.focal_px = {400, 400}, .principal_px = {160, 90}}};
  return test::layeredFrame(1, camera, kSource_px, {layer});
}

// A surface may lie off a sheet by more than in focus where it is blurred.
TEST_F(LensList, takesWhatIsBlurredForOneSheetMoreReadily) {
  constexpr float kWall_inv_m = 0.5F;
  constexpr float kStep_inv_m = 0.012F;
  SyntheticLayer wall;
  wall.color.assign(4 * kSource_px.area(), 200);
  for (uint32_t px = 0; px < kSource_px.area(); ++px) {
    const bool is_nearer = px % kSource_px.width / 16 % 2 != 0;
    wall.depth_m.push_back(1 / (is_nearer ? kWall_inv_m + kStep_inv_m : kWall_inv_m));
  }
  const Camera camera{.pose = {},
                      .intrinsics = {.focal_px = {400, 400}, .principal_px = {160, 90}}};
  const BuiltFrame built(device(), shared<StructureBuilder>(),
                         test::layeredFrame(1, camera, kSource_px, {wall}));
  const HostStructure host = hostStructure(built.structure.firstPart());
  abi::ViewParams view{};
  view.direction = {0, 0, 1};
  view.direction_dx = {1, 0, 0};
  view.direction_dy = {0, 1, 0};
  view.lens_px_m = {32, 32};
  SheetList list;
  const auto listFocusedAt = [&](float inv_focus) {
    view.lens_inv_focus = inv_focus;
    // Across a step.
    list.find(host, view, {156, 80}, {164, 88});
  };
  // An eighth of a px of 32 for each 1/m is less than the step.
  listFocusedAt(kWall_inv_m);
  EXPECT_EQ(list.sheets().size(), 2U);
  // A blur of 16 px lets five eighths pass.
  listFocusedAt(0);
  EXPECT_EQ(list.sheets().size(), 1U);
  EXPECT_TRUE(list.isSettled());
}

// The texel of a row that a ray is taken to see which begins in front of everything, and ends at a
// place of it; `pace_px_m`: how that moves for each 1/m.
int32_t guessedTexel(const HostStructure& host, float end_px, float pace_px_m) {
  constexpr float kRow_px = 90;
  abi::ViewParams view{};
  view.eye = {pace_px_m, 0, 0};
  view.direction = {end_px - 0.5F, kRow_px, 1};
  view.direction_dx = {1, 0, 0};
  view.direction_dy = {0, 1, 0};
  const LensPoint middle{};
  const abi::MetSheet sheets[] = {{.plane = {0, 0, 1}, .layer = 0, .reach = 1e-3F},
                                  {.plane = {0, 0, 0.25F}, .layer = 0, .reach = 1e-3F}};
  const GatheredRays rays{
      .structure = host, .view = view, .points = std::span(&middle, 1), .sheets = sheets};
  const int32_t texel = guessSeen(rays, {.px = 0, .point = 0});
  return texel < 0 ? texel : texel - int32_t(kRow_px) * int32_t(kSource_px.width);
}

// One that passes behind the board, and behind it behind the wall, too.
TEST_F(LensList, takesAnOpenRayToSeeTheFarSideOfWhatItPassedBehind) {
  const BuiltFrame built(device(), shared<StructureBuilder>(), boardFrame());
  const HostStructure host = hostStructure(built.structure.firstPart());
  EXPECT_EQ(guessedTexel(host, 150, -60), int32_t(kBoardFirst_px) - 1);
  EXPECT_EQ(guessedTexel(host, 90, 60), int32_t(kBoardEnd_px));
  // Behind the wall alone: what it passed into, at 60 - 10 / 4.
  EXPECT_EQ(guessedTexel(host, 60, -10), 57);
  // From further away than px can be told.
  EXPECT_EQ(guessedTexel(host, 120, 3e38F), kNothingSeen);
}

}  // namespace
}  // namespace viewloom::lens_list_test
