// SPDX-License-Identifier: Apache-2.0
#include "frame/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>

namespace viewloom::camera_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
// Rounding of a few dozen operations on numbers of the order of 10.
constexpr double kRounding = 1e-12;

Pose randomPose(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const glm::dquat any(uniform(random), uniform(random), uniform(random), uniform(random));
  return {.position_m = {5 * uniform(random), 5 * uniform(random), 5 * uniform(random)},
          .orientation = glm::normalize(any)};
}

glm::dmat4 matrixOf(const Pose& pose) {
  return glm::translate(glm::dmat4(1), pose.position_m) * glm::mat4_cast(pose.orientation);
}

TEST(Pose, composesLikeMatrices) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const Pose outer = randomPose(random);
    const Pose inner = randomPose(random);
    const glm::dmat4 expected = matrixOf(outer) * matrixOf(inner);
    const glm::dmat4 got = matrixOf(compose(outer, inner));
    for (int column = 0; column < 4; ++column) {
      EXPECT_LT(glm::length(got[column] - expected[column]), kRounding);
    }
  }
}

TEST(Pose, composedWithItsInverseStandsAtTheOrigin) {
  std::mt19937 random(2);
  for (int i = 0; i < 100; ++i) {
    const Pose pose = randomPose(random);
    const Pose identity = compose(inverse(pose), pose);
    EXPECT_LT(glm::length(identity.position_m), kRounding);
    EXPECT_NEAR(std::abs(identity.orientation.w), 1, kRounding);
  }
}

TEST(Pose, turnsAboutTheUpAxisToTheLeft) {
  const Pose turned{.orientation = glm::angleAxis(std::numbers::pi / 2, glm::dvec3(0, 1, 0))};
  const Pose ahead{.position_m = {0, 0, -1}};
  EXPECT_LT(glm::length(compose(turned, ahead).position_m - glm::dvec3(-1, 0, 0)), kRounding);
}

TEST(Fov, putsItsEdgesOnTheImageBorder) {
  const Fov fov{.left_rad = -0.7, .right_rad = 0.4, .up_rad = 0.5, .down_rad = -0.2};
  const SizePx size_px{640, 480};
  const Intrinsics camera = intrinsicsFromFov(fov, size_px);
  // x_px = principal + focal * tan(angle) to the right; y_px runs downwards.
  EXPECT_NEAR(camera.principal_px.x + camera.focal_px.x * std::tan(fov.left_rad), 0, 1e-9);
  EXPECT_NEAR(camera.principal_px.x + camera.focal_px.x * std::tan(fov.right_rad), 640, 1e-9);
  EXPECT_NEAR(camera.principal_px.y - camera.focal_px.y * std::tan(fov.up_rad), 0, 1e-9);
  EXPECT_NEAR(camera.principal_px.y - camera.focal_px.y * std::tan(fov.down_rad), 480, 1e-9);
}

TEST(Fov, comesBackFromIntrinsics) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> angle(-1.5, 1.5);
  for (int i = 0; i < 200; ++i) {
    const auto [left, right] = std::minmax({angle(random), angle(random)});
    const auto [down, up] = std::minmax({angle(random), angle(random)});
    const Fov fov{.left_rad = left, .right_rad = right, .up_rad = up, .down_rad = down};
    if (!validateFov(fov, "fov").ok()) continue;
    const SizePx size_px{1 + static_cast<uint32_t>(i) * 37, 1 + static_cast<uint32_t>(i)};
    const Fov back = fovFromIntrinsics(intrinsicsFromFov(fov, size_px), size_px);
    EXPECT_NEAR(back.left_rad, left, 1e-9);
    EXPECT_NEAR(back.right_rad, right, 1e-9);
    EXPECT_NEAR(back.up_rad, up, 1e-9);
    EXPECT_NEAR(back.down_rad, down, 1e-9);
  }
}

TEST(ValidatePose, refusesWhatIsNoPoseAndNamesTheField) {
  const auto field_of = [](const Pose& pose) { return fieldOf(validatePose(pose, "pose")); };
  EXPECT_TRUE(validatePose({}, "pose").ok());
  EXPECT_EQ(field_of({.position_m = {kNan, 0, 0}}), "pose.position");
  EXPECT_EQ(field_of({.position_m = {0, -kInf, 0}}), "pose.position");
  EXPECT_EQ(field_of({.position_m = {0, 0, 1e300}}), "pose.position");
  EXPECT_EQ(field_of({.orientation = {kNan, 0, 0, 0}}), "pose.orientation");
  EXPECT_EQ(field_of({.orientation = {kInf, 0, 0, 0}}), "pose.orientation");
  EXPECT_EQ(field_of({.orientation = {0, 0, 0, 0}}), "pose.orientation");
}

TEST(ValidatePose, takesQuaternionsOfUnitLengthWithinAThousandth) {
  const auto accepts = [](double length) {
    return validatePose({.orientation = {0, length, 0, 0}}, "pose").ok();
  };
  EXPECT_TRUE(accepts(0.9991));
  EXPECT_TRUE(accepts(1.0009));
  EXPECT_FALSE(accepts(0.9989));
  EXPECT_FALSE(accepts(1.0011));
}

TEST(ValidateFov, refusesZeroCrossedAndImpossibleAngles) {
  const Fov good{.left_rad = -0.5, .right_rad = 0.5, .up_rad = 0.4, .down_rad = -0.4};
  const auto field_with = [&](double Fov::*angle, double value) {
    Fov fov = good;
    fov.*angle = value;
    return fieldOf(validateFov(fov, "fov"));
  };
  EXPECT_TRUE(validateFov(good, "fov").ok());
  EXPECT_EQ(field_with(&Fov::right_rad, -0.5), "fov.angle_right_rad");  // zero width
  EXPECT_EQ(field_with(&Fov::right_rad, -0.6), "fov.angle_right_rad");  // crossed
  EXPECT_EQ(field_with(&Fov::down_rad, 0.4), "fov.angle_up_rad");
  EXPECT_EQ(field_with(&Fov::up_rad, -0.9), "fov.angle_up_rad");
  EXPECT_EQ(field_with(&Fov::left_rad, -std::numbers::pi / 2), "fov.angle_left_rad");
  EXPECT_EQ(field_with(&Fov::up_rad, 2.0), "fov.angle_up_rad");
  EXPECT_EQ(field_with(&Fov::down_rad, kNan), "fov.angle_down_rad");
  EXPECT_EQ(field_with(&Fov::left_rad, -kInf), "fov.angle_left_rad");
  EXPECT_FALSE(validateFov({}, "fov").ok());
}

TEST(ValidateFov, leavesOnlyAnglesWhoseIntrinsicsAreAccepted) {
  const double widest = 1.57079;
  const double narrow = 1.1e-6;
  for (const SizePx size_px : {SizePx{1, 1}, SizePx{16384, 16384}}) {
    for (const Fov& fov : {Fov{-widest, widest, widest, -widest}, Fov{0, narrow, narrow, 0}}) {
      ASSERT_TRUE(validateFov(fov, "fov").ok());
      EXPECT_TRUE(validateIntrinsics(intrinsicsFromFov(fov, size_px), "camera").ok());
    }
  }
}

TEST(ValidateIntrinsics, refusesWhatIsNoPinhole) {
  const Intrinsics good{.focal_px = {500, 500}, .principal_px = {-100, 9000}};
  EXPECT_TRUE(validateIntrinsics(good, "intrinsics").ok());
  for (const double bad : {0.0, -1.0, kNan, kInf}) {
    Intrinsics x = good;
    x.focal_px.x = bad;
    EXPECT_EQ(fieldOf(validateIntrinsics(x, "intrinsics")), "intrinsics.focal_x_px");
    Intrinsics y = good;
    y.focal_px.y = bad;
    EXPECT_EQ(fieldOf(validateIntrinsics(y, "intrinsics")), "intrinsics.focal_y_px");
  }
  for (const double bad : {kNan, kInf, -kInf}) {
    Intrinsics x = good;
    x.principal_px.x = bad;
    EXPECT_EQ(fieldOf(validateIntrinsics(x, "intrinsics")), "intrinsics.principal_x_px");
    Intrinsics y = good;
    y.principal_px.y = bad;
    EXPECT_EQ(fieldOf(validateIntrinsics(y, "intrinsics")), "intrinsics.principal_y_px");
  }
}

}  // namespace
}  // namespace viewloom::camera_test
