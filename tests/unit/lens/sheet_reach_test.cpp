// SPDX-License-Identifier: Apache-2.0
// How far off a sheet surfaces may lie, beside how far apart rays through the lens pass them.
#include "shared/sheet_reach.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace viewloom::sheet_reach_test {
namespace {

// Error of about ten operations in binary32, with differences of places up to 1000 px.
constexpr double kRelativeError = 1e-3;

abi::ViewParams someView(std::mt19937& random) {
  std::uniform_real_distribution<float> unit(-1, 1);
  abi::ViewParams view{};
  view.eye = {200 * unit(random), 200 * unit(random), 0.4F * unit(random)};
  view.direction = {100 * unit(random), 100 * unit(random), 0.9F};
  view.direction_dx = {1.2F, 0.1F * unit(random), 1e-3F * unit(random)};
  view.direction_dy = {0.1F * unit(random), 1.1F, 1e-3F * unit(random)};
  view.lens_px_m = {8 + 6 * unit(random), 8 + 6 * unit(random)};
  view.lens_inv_focus = 0.6F + 0.5F * unit(random);
  return view;
}

glm::dvec2 placeAt(const glm::dvec3& eye, const glm::dvec3& direction, double inv_z) {
  return glm::dvec2(direction) / direction.z * (1 - inv_z * eye.z) + inv_z * glm::dvec2(eye);
}

// By a lens, at the 1/Z: how far a ray through its rim is from the one through its middle, px.
double blurAt(const abi::ViewParams& view, double inv_z) {
  const glm::dvec3 eye(view.eye);
  const glm::dvec3 direction(view.direction);
  const glm::dvec2 middle = placeAt(eye, direction, inv_z);
  const auto radius = [&](const glm::dvec3& moved) {
    const glm::dvec3 turned = direction - double(view.lens_inv_focus) * moved;
    return glm::distance(placeAt(eye + moved, turned, inv_z), middle);
  };
  return std::max(radius(double(view.lens_px_m.x) * glm::dvec3(view.direction_dx)),
                  radius(double(view.lens_px_m.y) * glm::dvec3(view.direction_dy)));
}

abi::SheetReach reachOf(const abi::ViewParams& view, double inv_z) {
  const glm::dvec2 at = placeAt(glm::dvec3(view.eye), glm::dvec3(view.direction), inv_z);
  return abi::sheetReach(view, abi::vec2(at), view.direction.z);
}

// By how far 1/Z of a surface at that place may be off, a ray through the rim meets it the stated
// part of a px beside: that is moved by how far the eye is from the source's, and by the lens.
TEST(SheetReach, movesAFocusedRayByAnEighthOfAPx) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> place_px(0, 640);
  for (int i = 0; i < 1000; ++i) {
    const abi::ViewParams view = someView(random);
    const glm::dvec2 at(place_px(random), place_px(random));
    // A homogeneous point beside the source moves what it is projected along by that for each 1/m.
    const auto moved_px_m = [&](const glm::dvec3& by) {
      return glm::length(glm::dvec2(by) - at * by.z);
    };
    const double all_px_m =
        moved_px_m(glm::dvec3(view.eye)) +
        std::max(moved_px_m(double(view.lens_px_m.x) * glm::dvec3(view.direction_dx)),
                 moved_px_m(double(view.lens_px_m.y) * glm::dvec3(view.direction_dy)));
    const double in_focus = abi::sheetReach(view, abi::vec2(at), view.direction.z).in_focus;
    ASSERT_NEAR(in_focus * all_px_m, 0.125, kRelativeError * 0.125);
  }
}

TEST(SheetReach, growsInProportionToTheBlur) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> near(0.02, 2);
  for (int i = 0; i < 1000; ++i) {
    abi::ViewParams view = someView(random);
    // So that its axes are turned by the lens alone: what a ray that goes another way sees of it
    // is another matter.
    view.direction_dx.z = view.direction_dy.z = 0;
    const double inv_z = near(random);
    const abi::SheetReach reach = reachOf(view, inv_z);
    const double px_inv_m = abi::kSheetReach_px / double(reach.in_focus);
    const double looser_px =
        px_inv_m * (double(abi::leastReach(reach, float(inv_z), float(inv_z))) - reach.in_focus);
    ASSERT_NEAR(looser_px, double(abi::kSheetReachOfBlur) * blurAt(view, inv_z),
                kRelativeError * (looser_px + abi::kSheetReach_px));
  }
}

TEST(SheetReach, isTheLeastOfWhatLiesInARange) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> place(0, 2);
  for (int i = 0; i < 1000; ++i) {
    const abi::SheetReach reach = reachOf(someView(random), 0.5);
    float least = place(random);
    float largest = place(random);
    if (least > largest) std::swap(least, largest);
    constexpr int kSteps = 1000;
    float sought = std::numeric_limits<float>::infinity();
    for (int step = 0; step <= kSteps; ++step) {
      const float inv_z = least + (largest - least) * float(step) / kSteps;
      sought = std::min(sought, abi::leastReach(reach, inv_z, inv_z));
    }
    // No more than half a step beside where it is least.
    const float between = reach.of_blur_inv_z * (largest - least) / kSteps;
    const float got = abi::leastReach(reach, least, largest);
    ASSERT_LE(got, sought * (1 + float(kRelativeError)));
    ASSERT_GE(got, sought - std::abs(between) - float(kRelativeError) * sought);
    ASSERT_GE(got, reach.in_focus);
  }
}

// Then 1/Z does not tell how much a ray is blurred.
TEST(SheetReach, isThatInFocusForRaysThatGoAside) {
  std::mt19937 random(7);
  const abi::ViewParams view = someView(random);
  for (const float direction_z : {0.0F, -1.0F, 0.5F * abi::kForwardMin}) {
    const abi::SheetReach reach = abi::sheetReach(view, {100, 50}, direction_z);
    EXPECT_EQ(abi::leastReach(reach, 0.1F, 0.1F), reach.in_focus);
    EXPECT_TRUE(std::isfinite(reach.in_focus));
  }
}

}  // namespace
}  // namespace viewloom::sheet_reach_test
