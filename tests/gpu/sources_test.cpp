// SPDX-License-Identifier: Apache-2.0
// Several sources traced together, a cube map among them or none, answer as the oracle does, and
// each planted mistake is found.
#include <iostream>
#include <ostream>

#include "gpu/cube_beside_sources.h"
#include "gpu/sources_under_test.h"
#include "shared/fault.h"
#include "support/test_device.h"

namespace viewloom::sources_test {
namespace {

// Share of rays: random scenes are all edges, and where moved rays disagree nothing can be said.
constexpr double kExcusedMax = 0.06;

using JudgeSeed = oracle::Verdict (*)(SourcesUnderTest& tracer, uint64_t seed);

oracle::Verdict judgeSeeds(SourcesUnderTest& tracer, JudgeSeed judge, uint64_t count) {
  oracle::Verdict verdict;
  for (uint64_t seed = 0; seed < count; ++seed) verdict.add(judge(tracer, seed));
  return verdict;
}

struct RandomSources {
  JudgeSeed judge;
  uint64_t seed_count;
  const char* name;
};

class SourcesTest : public GpuTest, public testing::WithParamInterface<RandomSources> {};

TEST_P(SourcesTest, areMergedAsTheOracleSays) {
  const oracle::Verdict verdict =
      judgeSeeds(shared<SourcesUnderTest>(), GetParam().judge, GetParam().seed_count);
  std::cout << verdict.summary() << "\n";
  EXPECT_EQ(verdict.differing, 0U) << verdict.summary();
  EXPECT_LE(verdict.excusedShare(), kExcusedMax);
}

INSTANTIATE_TEST_SUITE_P(Random, SourcesTest,
                         testing::Values(RandomSources{judgeSources, 60, "pinholes"},
                                         RandomSources{judgeCubeBesideSources, 40, "besideACube"}),
                         [](const testing::TestParamInfo<RandomSources>& sources) {
                           return sources.param.name;
                         });

struct OnceDiffered {
  JudgeSeed judge;
  uint64_t seed;
  const char* mistake;
};

std::ostream& operator<<(std::ostream& out, const OnceDiffered& once) {
  return out << "seed " << once.seed << " " << once.mistake;
}

// It had seen rays from millions of metres on, or all eyes were taken to be in its plane.
constexpr const char* kSkySeenWrong = "has a source of nothing but sky refute the wrong hits";

constexpr OnceDiffered kSeeds[] = {
    {judgeSources, 136, kSkySeenWrong},
    {judgeSources, 223, kSkySeenWrong},
    {judgeSources, 678, "has 1/Z of what two equal numbers leave, as the eye is 0.3 mm off"},
    {judgeCubeBesideSources, 69, "is refuted by nothing but sky that was not seen"},
    {judgeCubeBesideSources, 1045, "weighs the sky by rounding, as if a slope was seen edge on"},
};

class SourcesThatDiffered : public GpuTest, public testing::WithParamInterface<OnceDiffered> {};

TEST_P(SourcesThatDiffered, agreeWithTheOracle) {
  const oracle::Verdict verdict = GetParam().judge(shared<SourcesUnderTest>(), GetParam().seed);
  EXPECT_EQ(verdict.differing, 0U) << verdict.summary();
}

INSTANTIATE_TEST_SUITE_P(Once, SourcesThatDiffered, testing::ValuesIn(kSeeds));

struct PlantedFault {
  uint32_t fault;
  JudgeSeed judge;
  const char* name;
};

class SourcesFaultTest : public DeviceNeededTest,
                         public testing::WithParamInterface<PlantedFault> {};

TEST_P(SourcesFaultTest, isFound) {
  constexpr uint64_t kSeedCount = 12;
  const Device device({.planted_fault = GetParam().fault});
  SourcesUnderTest tracer(device);
  const oracle::Verdict verdict = judgeSeeds(tracer, GetParam().judge, kSeedCount);
  EXPECT_GT(verdict.differing, 0U) << verdict.summary();
}

INSTANTIATE_TEST_SUITE_P(
    Each, SourcesFaultTest,
    testing::Values(PlantedFault{abi::kFaultFarthestHit, judgeSources, "farthestHit"},
                    PlantedFault{abi::kFaultWeightsSwapped, judgeSources, "weightsSwapped"},
                    PlantedFault{abi::kFaultHiddenWins, judgeSources, "hiddenWins"},
                    PlantedFault{abi::kFaultNoRefuting, judgeSources, "noRefuting"},
                    PlantedFault{abi::kFaultNoBlend, judgeSources, "noBlend"},
                    PlantedFault{abi::kFaultCubeSawNothing, judgeCubeBesideSources,
                                 "cubeSawNothing"}),
    [](const testing::TestParamInfo<PlantedFault>& fault) { return fault.param.name; });

}  // namespace
}  // namespace viewloom::sources_test
