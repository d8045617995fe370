// SPDX-License-Identifier: Apache-2.0
// Several sources traced together answer as the oracle does, and each planted mistake is found.
#include <iostream>

#include "gpu/sources_under_test.h"
#include "gpu/test_device.h"
#include "shared/fault.h"

namespace viewloom {
namespace {

constexpr double kTolerances_px[] = {0.25, 0.05, 0.01};
// Of rays: random scenes are all edges, and where moved rays disagree nothing can be said.
constexpr double kExcusedMax = 0.06;

oracle::Verdict judgeSeeds(const Device& device, uint64_t first, uint64_t count) {
  SourcesUnderTest tracer(device);
  oracle::Verdict verdict;
  for (uint64_t seed = first; seed < first + count; ++seed) {
    verdict.add(judgeSources(tracer, seed, kTolerances_px[seed % 3]));
  }
  return verdict;
}

class SourcesTest : public GpuTest {};

TEST_F(SourcesTest, randomSourcesAreMergedAsTheOracleSays) {
  const oracle::Verdict verdict = judgeSeeds(device(), 0, 60);
  std::cout << verdict.summary() << "\n";
  EXPECT_EQ(verdict.differing, 0U) << verdict.summary();
  EXPECT_LE(verdict.excusedShare(), kExcusedMax);
}

struct PlantedFault {
  uint32_t fault;
  const char* name;
};

class SourcesFaultTest : public DeviceNeededTest,
                         public testing::WithParamInterface<PlantedFault> {};

TEST_P(SourcesFaultTest, isFound) {
  const Device device({.planted_fault = GetParam().fault});
  const oracle::Verdict verdict = judgeSeeds(device, 0, 12);
  EXPECT_GT(verdict.differing, 0U) << verdict.summary();
}

INSTANTIATE_TEST_SUITE_P(Each, SourcesFaultTest,
                         testing::Values(PlantedFault{abi::kFaultFarthestHit, "farthestHit"},
                                         PlantedFault{abi::kFaultWeightsSwapped, "weightsSwapped"},
                                         PlantedFault{abi::kFaultHiddenWins, "hiddenWins"},
                                         PlantedFault{abi::kFaultNoRefuting, "noRefuting"},
                                         PlantedFault{abi::kFaultNoBlend, "noBlend"}),
                         [](const testing::TestParamInfo<PlantedFault>& fault) {
                           return fault.param.name;
                         });

}  // namespace
}  // namespace viewloom
