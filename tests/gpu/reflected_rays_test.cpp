// SPDX-License-Identifier: Apache-2.0
// Reflected rays of random scenes by the oracle: which way they go, where they start, and what they
// meet. Each mistake planted in the shaders is found.
#include <iostream>

#include "gpu/followed_mirrors.h"
#include "shared/fault.h"
#include "support/test_device.h"

namespace viewloom::reflected_rays_test {
namespace {

// Tolerance of the views. The smaller it is, the less is left to the judge.
constexpr double kTolerance_px = 0.0001;
constexpr double kExcusedShareMax = 0.01;
// Share of the places behind bodies: a few ulps decide whether three samples bend as an ellipse.
constexpr double kExcusedBodiesMax = 0.01;

JudgedMirrors lookAt(const Device& device, uint64_t first_seed, uint64_t seed_count) {
  MirrorFollower follower(device);
  JudgedMirrors judged;
  for (uint64_t seed = first_seed; seed < first_seed + seed_count; ++seed) {
    oracle::Random random(seed);
    const auto views = oracle::randomViews(random, oracle::kViewKindCount, 13, 10);
    judged.add(judgeMirrors(follower, oracle::randomScene(seed), views, kTolerance_px,
                            "seed " + std::to_string(seed)));
  }
  return judged;
}

using ReflectedRaysTest = GpuTest;

TEST_F(ReflectedRaysTest, goAndMeetWhatTheOracleSays) {
  const JudgedMirrors judged = lookAt(device(), 1, 32);
  std::cout << judged.summary() << "\n";
  EXPECT_EQ(judged.verdict.differing, 0u);
  EXPECT_LE(judged.verdict.excusedShare(), kExcusedShareMax);
  EXPECT_GT(judged.bent_count, 0u);
  EXPECT_GT(judged.back_count, 0u);
  EXPECT_GT(judged.deeper_count, 0u);
  const JudgedBodies& bodies = judged.bodies;
  EXPECT_EQ(bodies.differing_count, 0u);
  EXPECT_LE(double(bodies.excused_count), kExcusedBodiesMax * double(bodies.count));
  EXPECT_GT(bodies.met_count, 0u);
  EXPECT_GT(bodies.passed_count, 0u);
}

struct PlantedFault {
  uint32_t fault;
  const char* name;
};

class ReflectedFaultTest : public DeviceNeededTest,
                           public testing::WithParamInterface<PlantedFault> {};

TEST_P(ReflectedFaultTest, isFound) {
  const Device device({.planted_fault = GetParam().fault});
  const JudgedMirrors judged = lookAt(device, 20, 10);
  EXPECT_GT(judged.verdict.differing + judged.bodies.differing_count, 0u) << judged.summary();
}

INSTANTIATE_TEST_SUITE_P(
    Each, ReflectedFaultTest,
    testing::Values(PlantedFault{abi::kFaultStartsOnSurface, "startsOnSurface"},
                    PlantedFault{abi::kFaultNormalTurned, "normalTurned"},
                    PlantedFault{abi::kFaultNotBent, "notBent"},
                    PlantedFault{abi::kFaultBacksPassed, "backsPassed"},
                    PlantedFault{abi::kFaultBeginsBehind, "beginsBehind"},
                    PlantedFault{abi::kFaultBodiesFlat, "bodiesFlat"}),
    [](const testing::TestParamInfo<PlantedFault>& fault) { return fault.param.name; });

}  // namespace
}  // namespace viewloom::reflected_rays_test
