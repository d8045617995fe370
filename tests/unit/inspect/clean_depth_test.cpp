// SPDX-License-Identifier: Apache-2.0
// Depth of many scenes, written as it should be: nothing is suspected.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "unit/inspect/depth_planes.h"
#include "unit/inspect/found_kinds.h"

namespace viewloom::inspect::clean_depth_test {
namespace {

using test::depthPlane;
using test::DepthPlane;
using test::kindsOf;
using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::Not;

// Depth that is as it should be, of many kinds: no word is said.
struct Clean {
  const char* name;
  std::function<float(float x, float y)> depth_m;  // x, y: 0..1 from the upper left
};
const std::vector<Clean>& cleanScenes() {
  static const std::vector<Clean> scenes{
      {"level floor and wall", [](float, float y) { return y < 0.5F ? 4 : 0.5F / (y - 0.375F); }},
      {"floor alone", [](float, float y) { return 0.6F / (y + 0.2F); }},
      {"tilted plane", [](float x, float y) { return 1 / (0.3F + 0.2F * x + 0.1F * y); }},
      {"plane that leans back", [](float, float y) { return 1 / (0.2F + 0.3F * y); }},
      {"wall at a slant", [](float x, float) { return 1 / (0.2F + 0.5F * x); }},
      {"corridor",
       [](float x, float y) {
         const float off = std::max(std::abs(x - 0.5F), std::abs(y - 0.5F));
         return std::min(12.0F, 0.6F / std::max(off, 0.01F));
       }},
      {"face before a wall",
       [](float x, float y) {
         const float r = 6 * ((x - 0.5F) * (x - 0.5F) + (y - 0.45F) * (y - 0.45F));
         return r < 0.5F ? 0.9F - 0.15F * std::sqrt(0.5F - r) : 2.5F + 0.03F * x;
       }},
      {"ball on a table",
       [](float x, float y) {
         const float r = (x - 0.6F) * (x - 0.6F) + (y - 0.6F) * (y - 0.6F);
         const float table = y < 0.4F ? 3 : 0.6F / (y - 0.2F);
         return r < 0.02F ? 1.1F - std::sqrt(0.02F - r) : table;
       }},
      {"landscape below a sky",
       [](float x, float y) {
         const float horizon = 0.45F + 0.05F * std::sin(9 * x);
         return y < horizon ? std::numeric_limits<float>::infinity() : 1.6F / (y - horizon + 0.02F);
       }},
      {"boards before a wall",
       [](float x, float y) {
         const bool is_left = x > 0.1F && x < 0.4F && y > 0.2F && y < 0.6F;
         const bool is_right = x > 0.6F && x < 0.8F && y > 0.5F && y < 0.9F;
         return is_left ? 1.5F : is_right ? 2.5F : 4.0F;
       }},
      {"hills",
       [](float x, float y) {
         return 2 + 0.4F * std::sin(7 * x + 1) * std::cos(5 * y) + 0.5F * (1 - y);
       }},
      {"window in a wall",
       [](float x, float y) {
         const bool is_open = x > 0.3F && x < 0.7F && y > 0.2F && y < 0.6F;
         return is_open ? 15.0F : 1 / (0.33F - 0.01F * x + 0.02F * y);
       }},
  };
  return scenes;
}

template <typename Sample>
std::vector<std::string> kindsOfClean(const Clean& scene, uint32_t width, uint32_t height,
                                      v1::DepthMeaning meaning, double codes, uint32_t code_max) {
  const auto sample = [&](uint32_t x, uint32_t y) {
    const double depth_m =
        double{scene.depth_m((float(x) + 0.5F) / float(width), (float(y) + 0.5F) / float(height))};
    const double value = meaning == v1::DEPTH_MEANING_DISPARITY ? 1 / depth_m : depth_m;
    return static_cast<Sample>(codes == 0 ? value : std::min(std::round(codes * value), 65000.0));
  };
  DepthPlane made = depthPlane<Sample>(width, height, meaning, sample);
  if (codes != 0) made.plane.mutable_depth()->set_scale(1 / codes);
  return kindsOf(made, code_max);
}

TEST(CleanDepth, raisesNoSuspicion) {
  const std::vector<std::pair<uint32_t, uint32_t>> sizes{{192, 128}, {96, 160}, {64, 64}, {24, 16}};
  for (const Clean& scene : cleanScenes()) {
    for (const auto& [width, height] : sizes) {
      const std::string what = scene.name + std::string(" ") + std::to_string(width);
      EXPECT_THAT(kindsOfClean<float>(scene, width, height, v1::DEPTH_MEANING_PLANAR, 0, 0),
                  IsEmpty())
          << what;
      EXPECT_THAT(kindsOfClean<float>(scene, width, height, v1::DEPTH_MEANING_DISPARITY, 0, 0),
                  IsEmpty())
          << what;
      EXPECT_THAT(
          kindsOfClean<uint16_t>(scene, width, height, v1::DEPTH_MEANING_DISPARITY, 20000, 65535),
          IsEmpty())
          << what;
    }
  }
}

// Rows of a floor seen level: 1/Z rises by the same from row to row, and so there are no steps.
TEST(CleanDepth, hasNoStepsInTheRowsOfALevelFloor) {
  for (const double per_row : {0.0125, 0.025, 0.003}) {
    const DepthPlane floor =
        depthPlane<float>(192, 64, v1::DEPTH_MEANING_PLANAR, [per_row](uint32_t x, uint32_t y) {
          const bool is_board = x > 30 && x < 80 && y > 5 && y < 25;
          const bool is_disc = x > 120 && x < 150 && y > 25 && y < 45;
          const double floor_inv_z = 0.25 + per_row * std::max(0.0, double(y) - 30);
          return static_cast<float>(1 / (is_board ? 1 / 1.5 : is_disc ? 0.4 : floor_inv_z));
        });
    EXPECT_THAT(kindsOf(floor), Not(Contains("quantised"))) << per_row;
  }
}

}  // namespace
}  // namespace viewloom::inspect::clean_depth_test
