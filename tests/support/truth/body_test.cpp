// SPDX-License-Identifier: Apache-2.0
// Rays and bodies against closed forms.
#include "support/truth/body.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

namespace viewloom::truth::body_test {
namespace {

// Relative to lengths around 1 m: some hundred roundings of binary64.
constexpr double kRounding_m = 1e-13;
// Steps along a ray that decide on which side of a surface they end.
constexpr double kStep_m = 1e-7;

bool holds(const Sphere& sphere, const glm::dvec3& at_m) {
  return glm::length(at_m) < sphere.radius_m;
}
bool holds(const Box& box, const glm::dvec3& at_m) {
  return glm::all(glm::lessThan(glm::abs(at_m), box.half_m));
}
bool holds(const Cylinder& cylinder, const glm::dvec3& at_m) {
  return std::hypot(at_m.x, at_m.z) < cylinder.radius_m && std::abs(at_m.y) < cylinder.half_m;
}

bool isInside(const Shape& shape, const glm::dvec3& at_m) {
  return std::visit([&](const auto& solid) { return holds(solid, at_m); }, shape);
}

glm::dvec3 along(const Ray& ray, double depth) {
  return ray.origin_m + depth * ray.direction;
}

TEST(TruthBody, aSphereAheadIsMetItsRadiusBeforeItsCenter) {
  const auto entry = entryInto(Sphere{0.75}, {{0, 3, 4}, {0, -0.6, -0.8}});
  ASSERT_TRUE(entry.has_value());
  EXPECT_NEAR(entry->depth, 5 - 0.75, kRounding_m);
  EXPECT_NEAR(glm::distance(entry->normal, glm::dvec3(0, 0.6, 0.8)), 0, kRounding_m);
}

TEST(TruthBody, depthsCountInTheLengthOfTheDirection) {
  const auto entry = entryInto(Sphere{1}, {{0, 0, 5}, {0, 0, -2}});
  ASSERT_TRUE(entry.has_value());
  EXPECT_NEAR(entry->depth, 2, kRounding_m);
}

TEST(TruthBody, aSphereIsMissedByRaysThatPassFurtherThanItsRadius) {
  for (const double x_m : {-1.001, -0.999, 0.999, 1.001}) {
    const bool meets = std::abs(x_m) < 1;
    const auto entry = entryInto(Sphere{1}, {{x_m, 0, 5}, {0, 0, -1}});
    ASSERT_EQ(entry.has_value(), meets) << x_m;
    if (!meets) continue;
    EXPECT_NEAR(entry->depth, 5 - std::sqrt(1 - x_m * x_m), kRounding_m);
  }
}

TEST(TruthBody, raysEnterSolidsWhereTheirInsideBegins) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto point = [&] { return glm::dvec3(uniform(random), uniform(random), uniform(random)); };
  const Shape shapes[] = {Sphere{0.5}, Box{{0.3, 0.5, 0.2}}, Cylinder{0.3, 0.4},
                          Cylinder{0.05, 0.9}};
  int entered_count = 0;
  for (int i = 0; i < 4000; ++i) {
    const Shape& shape = shapes[i % 4];
    const glm::dvec3 origin_m = 3.0 * glm::normalize(point());
    const Ray ray{origin_m, glm::normalize(0.7 * point() - origin_m)};
    const auto entry = entryInto(shape, ray);
    if (!entry) {
      for (double depth = 0; depth < 6; depth += 0.01) {
        ASSERT_FALSE(isInside(shape, along(ray, depth))) << "ray " << i << " at " << depth;
      }
      continue;
    }
    ++entered_count;
    EXPECT_FALSE(isInside(shape, along(ray, entry->depth - kStep_m))) << "ray " << i;
    // Where a ray but touches, inside is shorter than the step.
    const double facing = -glm::dot(entry->normal, ray.direction);
    EXPECT_GT(facing, 0) << "ray " << i;
    if (facing > 0.01) {
      EXPECT_TRUE(isInside(shape, along(ray, entry->depth + kStep_m))) << "ray " << i;
    }
    EXPECT_NEAR(glm::length(entry->normal), 1, kRounding_m);
  }
  EXPECT_GT(entered_count, 1000);
}

TEST(TruthBody, aSheetIsMetFromBothSidesInItsPlane) {
  const Box sheet{{0.5, 0.5, 0}};
  for (const double side : {-1.0, 1.0}) {
    const auto entry = entryInto(sheet, {{0.2, 0.1, 2 * side}, {0.1, 0, -side}});
    ASSERT_TRUE(entry.has_value());
    EXPECT_EQ(entry->depth, 2);
    EXPECT_EQ(entry->normal, glm::dvec3(0, 0, side));
    EXPECT_FALSE(entryInto(sheet, {{0.2, 0.6, 2 * side}, {0, 0, -side}}).has_value());
  }
}

TEST(TruthBody, nothingIsMetFromInsideOrBehindTheOrigin) {
  for (const Shape& shape : {Shape(Sphere{1}), Shape(Box{{1, 1, 1}}), Shape(Cylinder{1, 1})}) {
    EXPECT_FALSE(entryInto(shape, {{0, 0, 0.5}, {0, 0, -1}}).has_value());
    EXPECT_FALSE(entryInto(shape, {{0, 0, 5}, {0, 0, 1}}).has_value());
  }
}

TEST(TruthBody, turnsAroundItsMovingCenter) {
  Body body;
  body.pose.position_m = {1, 2, 3};
  body.velocity_mps = {0.5, 0, 0};
  body.spin_rad_per_s = {0, 2, 0};
  const Pose pose = body.poseAt(0.25);
  EXPECT_NEAR(glm::distance(pose.position_m, glm::dvec3(1.125, 2, 3)), 0, kRounding_m);
  // Half a radian around +y takes +x towards -z.
  const glm::dvec3 x = pose.orientation * glm::dvec3(1, 0, 0);
  EXPECT_NEAR(glm::distance(x, glm::dvec3(std::cos(0.5), 0, -std::sin(0.5))), 0, kRounding_m);
}

TEST(TruthBody, paintHasWavesOfItsContrastAroundTheMeanOfBothColors) {
  const Paint paint{{0.75F, 0.5F, 0.25F}, {0.25F, 0.25F, 0.25F}, 0.1};
  for (double x_m = 0; x_m < 1; x_m += 0.013) {
    const glm::dvec3 at_m(x_m, 0.7, -0.2);
    EXPECT_EQ(paint.colorAt(at_m, 0), glm::vec3(0.5F, 0.375F, 0.25F));
    const glm::vec3 whole = paint.colorAt(at_m, 1);
    EXPECT_GE(whole.r, 0.25F);
    EXPECT_LE(whole.r, 0.75F);
    EXPECT_NEAR(paint.colorAt(at_m, 0.5F).r, 0.5F * (0.5F + whole.r), 1e-6F);
  }
}

}  // namespace
}  // namespace viewloom::truth::body_test
