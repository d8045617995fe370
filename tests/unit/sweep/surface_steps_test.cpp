// SPDX-License-Identifier: Apache-2.0
// Steps between surfaces, as they are measured: by the range of 1/Z alone, wherever infinity lies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <vector>

#include "sweep/sweep_source.h"

namespace viewloom::surface_steps_test {
namespace {

constexpr SizePx kSize_px{256, 192};
constexpr float kNear = 0.7F, kFar = 0.2F;  // 1/m
constexpr double kShifts[] = {0, 0.3, 10};

// Ramps of 1/Z at different places from kFar to kNear, a block of 4x4 px each, as one px of it is
// measured.
std::vector<float> blocksOfRange() {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> within(kFar, kNear);
  std::vector<float> inv_z(kSize_px.area());
  for (uint32_t y = 0; y < kSize_px.height; y += 4) {
    for (uint32_t x = 0; x < kSize_px.width; x += 4) {
      const float here = within(random);
      for (uint32_t i = 0; i < 16; ++i) inv_z[(y + i / 4) * kSize_px.width + x + i % 4] = here;
    }
  }
  return inv_z;
}

MeasuredColumns measuredOf(std::vector<float> inv_z, double shift, double given_kappa = 0) {
  for (float& each : inv_z) each = float(double{each} + shift);
  std::vector<uint8_t> bytes(inv_z.size() * sizeof(float));
  std::memcpy(bytes.data(), inv_z.data(), bytes.size());
  auto frame = std::make_shared<Frame>();
  SourceFormat& source = frame->format.sources.emplace_back();
  source.camera.intrinsics = {{200, 200}, {128, 96}};
  source.connection_tolerance = given_kappa;
  PlaneFormat& depth = source.layers.emplace_back().depth;
  depth.kind = PlaneKind::kDepth;
  depth.encoding = PlaneEncoding::kDepthF32;
  depth.size_px = kSize_px;
  depth.depth.meaning = DepthMeaning::kDisparity;
  frame->sources.emplace_back().emplace_back().depth =
      std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
  WorkerPool workers(1);
  SweepSource columns;
  columns.prepare(frame, workers);
  return columns.measured();
}

double percentile(std::vector<float> values, double share) {
  const auto rank = ptrdiff_t(share * double(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[size_t(rank)];
}

TEST(SurfaceSteps, areMeasuredByThePercentilesWhereverInfinityLies) {
  const std::vector<float> inv_z = blocksOfRange();
  for (const double shift : kShifts) {
    const SourceStats stats = measuredOf(inv_z, shift).stats;
    EXPECT_NEAR(stats.inv_z_near, percentile(inv_z, 0.98) + shift, 0.002) << shift;
    EXPECT_NEAR(stats.inv_z_far, percentile(inv_z, 0.02) + shift, 0.002) << shift;
  }
}

TEST(SurfaceSteps, moveWithTheSceneAndStayAsLarge) {
  const std::vector<float> inv_z = blocksOfRange();
  const SurfaceSteps plain = measuredOf(inv_z, 0).steps;
  EXPECT_NEAR(plain.kappa.at(kNear), 0.02 * 4 / 3 * plain.inv_z_range, 4e-4);
  EXPECT_NEAR(plain.deep.at(kNear), 0.15 * 4 / 3 * plain.inv_z_range, 3e-3);
  EXPECT_NEAR(plain.deep.at(kFar), 0.15 / 3 * plain.inv_z_range, 3e-3);
  for (const double shift : kShifts) {
    const SurfaceSteps steps = measuredOf(inv_z, shift).steps;
    for (const float at : {0.1F, kFar, 0.4F, kNear, 1.0F}) {
      const float shifted = float(double{at} + shift);
      EXPECT_NEAR(steps.kappa.at(shifted), plain.kappa.at(at), 4e-5) << at << " + " << shift;
      EXPECT_NEAR(steps.deep.at(shifted), plain.deep.at(at), 4e-4) << at << " + " << shift;
    }
  }
}

// A deep step leads from before(w) to w.
TEST(SurfaceSteps, leadBackFromWhereTheyLead) {
  const StepRule deep = measuredOf(blocksOfRange(), 0).steps.deep;
  for (const float inv_z : {0.0F, kFar, 0.3F, kNear}) {
    const float near = deep.before(inv_z);
    EXPECT_NEAR(near - deep.at(near), inv_z, 1e-6);
  }
}

TEST(SurfaceSteps, doNotSeeSpecksAndHoles) {
  std::vector<float> inv_z = blocksOfRange();
  const SurfaceSteps plain = measuredOf(inv_z, 0).steps;
  for (size_t i = 0; i < inv_z.size(); ++i) {
    const bool is_measured = i % 4 == 2 && i / kSize_px.width % 4 == 2;
    if (is_measured && i / 4 % 200 == 0) inv_z[i] = 1000;
    if (is_measured && i / 4 % 200 == 100) inv_z[i] = abi::kNoSurface;
  }
  const SurfaceSteps speckled = measuredOf(inv_z, 0).steps;
  EXPECT_NEAR(speckled.inv_z_range, plain.inv_z_range, 0.01 * double{plain.inv_z_range});
}

TEST(SurfaceSteps, ofAFlatSceneAreRoundings) {
  for (const double shift : kShifts) {
    const SurfaceSteps steps = measuredOf(std::vector<float>(kSize_px.area(), 0.5F), shift).steps;
    EXPECT_GT(steps.kappa.least, 0);
    EXPECT_LT(steps.kappa.at(float(0.5 + shift)), 1e-5 * (0.5 + shift));
    EXPECT_LT(steps.deep.at(float(0.5 + shift)), 1e-4 * (0.5 + shift));
  }
}

TEST(SurfaceSteps, withinASurfaceAreAsThePublisherSays) {
  for (const double shift : kShifts) {
    const SurfaceSteps steps = measuredOf(blocksOfRange(), shift, 0.03).steps;
    EXPECT_EQ(steps.kappa.at(float(kNear + shift)), 0.03F);
    EXPECT_EQ(steps.kappa.at(float(kFar + shift)), 0.03F);
  }
}

}  // namespace
}  // namespace viewloom::surface_steps_test
