// SPDX-License-Identifier: Apache-2.0
// Cube maps answer rays as the oracle does, and each planted mistake is found.
#include <iostream>

#include "gpu/cube_under_test.h"
#include "shared/fault.h"
#include "support/test_device.h"

namespace viewloom::cube_test {
namespace {

// Share of rays: random scenes are all edges, and where moved rays disagree nothing can be said.
constexpr double kExcusedMax = 0.06;

JudgedCube judgeSeeds(SourcesUnderTest& tracer, uint64_t first, uint64_t count) {
  JudgedCube judged;
  for (uint64_t seed = first; seed < first + count; ++seed) {
    judged.add(judgeCube(tracer, seed));
  }
  return judged;
}

class CubeTest : public GpuTest {};

TEST_F(CubeTest, randomCubeMapsAnswerAsTheOracleSays) {
  const JudgedCube judged = judgeSeeds(shared<SourcesUnderTest>(), 0, 60);
  const oracle::Verdict& verdict = judged.verdict;
  std::cout << verdict.summary() << "\n";
  EXPECT_TRUE(judged.complaints.empty()) << judged.complaints.text();
  EXPECT_EQ(verdict.differing, 0U) << verdict.summary();
  EXPECT_LE(verdict.excusedShare(), kExcusedMax);
}

struct OnceDiffered {
  uint64_t seed;
  const char* mistake;
};

// The judge allowed for planes that are off on the face alone that answers. Here another one's is,
// and is hit for that: 431 at its link to a lower layer in the seam, 963 at the edge of the face.
constexpr const char* kAnotherFaceIsOff = "hits another face within the tolerance";
// A ray from the cube's own place, within the overlap of two faces, began at the eye with both, but
// further off with that whose nearest surface is more than a metre away.
constexpr const char* kBeginsAtTheEye = "begins at the eye with two faces";

constexpr OnceDiffered kSeeds[] = {{431, kAnotherFaceIsOff},
                                   {727, kBeginsAtTheEye},
                                   {737, kBeginsAtTheEye},
                                   {963, kAnotherFaceIsOff},
                                   {1094, kBeginsAtTheEye}};

TEST_F(CubeTest, seedsThatOnceDifferedAgree) {
  SourcesUnderTest& tracer = shared<SourcesUnderTest>();
  for (const OnceDiffered& once : kSeeds) {
    const JudgedCube judged = judgeCube(tracer, once.seed);
    EXPECT_EQ(judged.verdict.differing, 0U) << once.mistake << "\n" << judged.verdict.summary();
  }
}

struct PlantedFault {
  uint32_t fault;
  const char* name;
};

class CubeFaultTest : public DeviceNeededTest, public testing::WithParamInterface<PlantedFault> {};

TEST_P(CubeFaultTest, isFound) {
  const Device device({.planted_fault = GetParam().fault});
  SourcesUnderTest tracer(device);
  const JudgedCube judged = judgeSeeds(tracer, 0, 12);
  EXPECT_GT(judged.verdict.differing, 0U) << judged.verdict.summary();
}

INSTANTIATE_TEST_SUITE_P(Each, CubeFaultTest,
                         testing::Values(PlantedFault{abi::kFaultApronEmpty, "apronEmpty"},
                                         PlantedFault{abi::kFaultFaceTurned, "faceTurned"},
                                         PlantedFault{abi::kFaultSeamPassed, "seamPassed"},
                                         PlantedFault{abi::kFaultSeamForgets, "seamForgets"},
                                         PlantedFault{abi::kFaultFirstFaceEnds, "firstFaceEnds"}),
                         [](const testing::TestParamInfo<PlantedFault>& fault) {
                           return fault.param.name;
                         });

}  // namespace
}  // namespace viewloom::cube_test
