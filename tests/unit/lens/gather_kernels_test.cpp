// SPDX-License-Identifier: Apache-2.0
// Rays of a block through a lens, compared with the same rays one by one in binary64. Runs with
// every instruction set of this CPU.
#include "lens/gather_kernels.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <bit>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "support/srgb_transfer.h"

namespace viewloom::gather_kernels_test {
namespace {

constexpr SizePx kImage_px = {40, 24};
constexpr uint32_t kPadded_px = 64;
constexpr uint32_t kArea_px = kImage_px.width * kImage_px.height;
constexpr uint32_t kBackground = 0xffff00ff;
constexpr float kReach = 0.01F;  // 1/m
// Further off a sheet than twice that, but not than twice as much again.
constexpr abi::vec3 kBeside(0, 0, 0.03F);
// Codes that binary32 may move a mean by, and the fits of the curve of sRGB: 0.06 and 0.09 codes
// each, and what a sum of them rounds.
constexpr double kCodeTolerance = 0.3;
// Rays that lie so close to an edge between two px that binary32 sees them in the other.
constexpr double kTiedShareMax = 0.02;

const glm::dvec3 kWall(0.002, -0.001, 0.3);
const glm::dvec3 kBoard(0.0, 0.003, 0.7);

double at(const glm::dvec3& plane, glm::dvec2 place) {
  return glm::dot(plane, glm::dvec3(place, 1));
}

// A board before a wall, which the second layer goes on behind it; a hole in the wall.
class Scene {
 public:
  Scene() : words_(2 * abi::layerWords(kPadded_px * kPadded_px)), texels_(2 * size_t{kArea_px}) {
    std::mt19937 random(7);
    for (uint32_t& texel : texels_) texel = 0xff000000 | random() % 0x1000000;
    for (uint32_t layer = 0; layer < 2; ++layer) {
      for (uint32_t y = 0; y < kImage_px.height; ++y) {
        for (uint32_t x = 0; x < kImage_px.width; ++x) store(layer, x, y);
      }
    }
  }

  static std::optional<glm::dvec3> planeAt(uint32_t layer, uint32_t x, uint32_t y) {
    const bool is_board = x >= 12 && x < 22 && y >= 6 && y < 30;
    if (x >= 30 && x < 33 && y < 8) return std::nullopt;
    if (layer == 0) return is_board ? kBoard : kWall;
    return is_board && x < 19 ? std::optional(kWall) : std::nullopt;
  }

  HostStructure structure() const {
    HostStructure structure{.size_px = kImage_px,
                            .padded_width = kPadded_px,
                            .padded_area = kPadded_px * kPadded_px,
                            .layer_count = 2,
                            .color = texels_.data(),
                            .color_stride = kArea_px,
                            .inv_z_max = 1};
    structure.cells[0] = words_.data();
    structure.cells[1] = words_.data() + words_.size() / 2;
    return structure;
  }

  uint32_t texel(uint32_t layer, glm::ivec2 px) const {
    return texels_[layer * kArea_px + uint32_t(px.y) * kImage_px.width + uint32_t(px.x)];
  }

 private:
  void store(uint32_t layer, uint32_t x, uint32_t y) {
    abi::uvec2& word =
        words_[layer * words_.size() / 2 +
               abi::levelOffset(abi::kLevelFacets, kPadded_px * kPadded_px) + y * kPadded_px + x];
    const std::optional<glm::dvec3> plane = planeAt(layer, x, y);
    if (!plane) {
      word = {abi::kNoFacet, 0};
      return;
    }
    const auto half = [](double slope) { return std::bit_cast<uint32_t>(float(slope)) >> 16; };
    word = {std::bit_cast<uint32_t>(float(at(*plane, {x + 0.5, y + 0.5}))),
            half(plane->x) | half(plane->y) << 16};
  }

  std::vector<abi::uvec2> words_;
  std::vector<uint32_t> texels_;
};

abi::ViewParams someView() {
  abi::ViewParams view{};
  view.eye = {4, -2, 0.05F};
  view.direction = {-6, -4, 1};
  view.direction_dx = {1.1F, 0.02F, 0.0004F};
  view.direction_dy = {-0.03F, 1.05F, -0.0003F};
  view.lens_px_m = {5, 5};
  view.lens_inv_focus = 0.45F;
  return view;
}

std::vector<LensPoint> somePoints(uint32_t count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> place(-0.7F, 0.7F);
  std::vector<LensPoint> points(count);
  for (LensPoint& point : points) {
    for (size_t p = 0; p < kBlockArea_px; ++p) {
      point.x[p] = place(random);
      point.y[p] = place(random);
    }
    point.beside_x_px = 0.5F * place(random);
    point.beside_y_px = 0.5F * place(random);
  }
  return points;
}

glm::dvec3 lightOf(uint32_t rgba) {
  glm::dvec3 light;
  for (int c = 0; c < 3; ++c) {
    const double srgb = double(rgba >> (8 * c) & 255) / 255;
    light[c] = linearFrom(srgb);
  }
  return light;
}

double codeOf(double light) {
  return 255 * srgbFrom(light);
}

// Colour of the nearest sheet that a ray of a pixel meets. Tests the sheets one after another.
std::optional<uint32_t> seen(const Scene& scene, const GatheredRays& rays, const LensPoint& point,
                             size_t p) {
  const abi::ViewParams& view = rays.view;
  const glm::dvec2 moved(view.lens_px_m.x * point.x[p], -view.lens_px_m.y * point.y[p]);
  const glm::dvec2 px(rays.first_x_px + float(p % 8) + 0.5F + point.beside_x_px,
                      rays.first_y_px + float(p / 8) + 0.5F + point.beside_y_px);
  const glm::dvec2 step = px - double(view.lens_inv_focus) * moved;
  const glm::dvec3 dx(view.direction_dx);
  const glm::dvec3 dy(view.direction_dy);
  const glm::dvec3 eye = glm::dvec3(view.eye) + moved.x * dx + moved.y * dy;
  const glm::dvec3 direction = glm::dvec3(view.direction) + step.x * dx + step.y * dy;
  double nearest = -2;
  std::optional<uint32_t> color;
  for (const abi::MetSheet& sheet : rays.sheets) {
    const glm::dvec3 plane(sheet.plane);
    // The point eye + s direction lies on the plane: plane . point = 1.
    const double s = (1 - glm::dot(plane, eye)) / glm::dot(plane, direction);
    const glm::dvec3 met = eye + s * direction;
    if (s <= 0 || met.z <= 0) continue;
    const glm::dvec2 place = glm::dvec2(met) / met.z;
    const glm::dvec2 nearby(std::clamp(place.x, 0.0, double(kImage_px.width)),
                            std::clamp(place.y, 0.0, double(kImage_px.height)));
    const bool is_beyond = place != nearby;
    const glm::ivec2 cell(std::min(int(nearby.x), int(kImage_px.width) - 1),
                          std::min(int(nearby.y), int(kImage_px.height) - 1));
    const auto facet = Scene::planeAt(sheet.layer, uint32_t(cell.x), uint32_t(cell.y));
    if (!facet || std::abs(at(*facet, nearby) - at(plane, nearby)) > 2 * sheet.reach) continue;
    const double key = is_beyond ? -1 : at(*facet, nearby);
    if (key <= nearest) continue;
    nearest = key;
    const glm::dvec2 end = glm::dvec2(direction) / direction.z;
    const bool ends_beyond =
        end.x < 0 || end.y < 0 || end.x > kImage_px.width || end.y > kImage_px.height;
    color = is_beyond && ends_beyond && !rays.fills_border ? kBackground
                                                           : scene.texel(sheet.layer, cell);
  }
  return color;
}

// The share of px whose mean of the rays that meet something is another, or of other rays.
double differingShare(const Scene& scene, const GatheredRays& rays, const BlockLight& of_rays) {
  BlockCodes codes;
  meanOf(of_rays, codes);
  uint32_t differing = 0;
  for (size_t p = 0; p < kBlockArea_px; ++p) {
    glm::dvec3 light(0);
    uint32_t count = 0;
    for (const LensPoint& point : rays.points) {
      const std::optional<uint32_t> color = seen(scene, rays, point, p);
      if (!color) continue;
      light += lightOf(*color);
      ++count;
    }
    light /= std::max(count, 1U);
    const bool is_same = float(count) == of_rays.count[p] &&
                         std::abs(codeOf(light.r) - codes.red[p]) <= kCodeTolerance &&
                         std::abs(codeOf(light.g) - codes.green[p]) <= kCodeTolerance &&
                         std::abs(codeOf(light.b) - codes.blue[p]) <= kCodeTolerance;
    differing += !is_same;
  }
  return differing / double(kBlockArea_px);
}

class GatherKernels : public ::testing::TestWithParam<int64_t> {
 protected:
  void SetUp() override { hwy::SetSupportedTargetsForTest(GetParam()); }
  void TearDown() override { hwy::SetSupportedTargetsForTest(0); }

  // Rays of a block that begins at (x, y).
  GatheredRays raysAt(float x, float y, bool fills_border) const {
    return {.structure = structure_,
            .view = view_,
            .first_x_px = x,
            .first_y_px = y,
            .points = points_,
            .sheets = sheets_,
            .fills_border = fills_border,
            .background = kBackground};
  }

  const Scene scene_;
  const HostStructure structure_ = scene_.structure();
  const abi::ViewParams view_ = someView();
  const std::vector<LensPoint> points_ = somePoints(10);
  const std::vector<abi::MetSheet> sheets_ = {{abi::vec3(kWall), 1, kReach},
                                              {abi::vec3(kWall), 0, kReach},
                                              {abi::vec3(kBoard) + kBeside, 0, 2 * kReach},
                                              {abi::vec3(kWall) + kBeside, 0, kReach}};
};

TEST_P(GatherKernels, seeTheNearestFacetOnASheet) {
  uint32_t block_count = 0;
  uint32_t many_sheets_count = 0;
  size_t all_open_count = 0;
  double share = 0;
  for (const bool fills_border : {false, true}) {
    for (float y = 0; y < 32; y += 8) {
      for (float x = 0; x < 48; x += 8) {
        const GatheredRays rays = raysAt(x, y, fills_border);
        BlockLight light{};
        std::vector<OpenRay> open;
        const MetSheets met = gatherOnSheets(rays, light, &open);
        share += differingShare(scene_, rays, light);
        OfBlock open_count{};
        for (const OpenRay& ray : open) ++open_count[ray.px];
        EXPECT_EQ(open_count, met.open_count);
        for (size_t p = 0; p < kBlockArea_px; ++p) {
          EXPECT_EQ(light.count[p] + open_count[p], float(points_.size()));
        }
        all_open_count += open.size();
        many_sheets_count += std::popcount(met.sheets) > 1;
        ++block_count;
      }
    }
  }
  EXPECT_LE(share / block_count, kTiedShareMax);
  EXPECT_GT(many_sheets_count, 8u);
  EXPECT_GT(all_open_count, 100u);
}

TEST_P(GatherKernels, seeASheetThatIsEverywhereAsOneOfMany) {
  // Far from the board; its right end lies beyond the image.
  GatheredRays rays = raysAt(32, 16, true);
  const std::vector<abi::MetSheet> wall = {{abi::vec3(kWall), 0, kReach}};
  rays.sheets = wall;
  BlockLight of_one{};
  BlockLight of_many{};
  gatherOnSheet(rays, of_one);
  const MetSheets met = gatherOnSheets(rays, of_many, nullptr);
  EXPECT_TRUE(met.is_all);
  EXPECT_EQ(met.sheets, 1u);
  EXPECT_EQ(of_one.count, of_many.count);
  EXPECT_LE(differingShare(scene_, rays, of_one), kTiedShareMax);
}

TEST_P(GatherKernels, leaveOutWhatIsBehindTheEye) {
  // 3 cm before the source.
  const std::vector<abi::MetSheet> near = {{abi::vec3(0, 0, 30), 0, kReach}};
  GatheredRays rays = raysAt(8, 8, true);
  rays.sheets = near;
  BlockLight light{};
  gatherOnSheet(rays, light);
  for (const float count : light.count) EXPECT_EQ(count, 0);
}

INSTANTIATE_TEST_SUITE_P(Targets, GatherKernels,
                         ::testing::ValuesIn(hwy::SupportedAndGeneratedTargets()),
                         [](const auto& target) { return hwy::TargetName(target.param); });

}  // namespace
}  // namespace viewloom::gather_kernels_test
