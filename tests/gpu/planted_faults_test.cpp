// SPDX-License-Identifier: Apache-2.0
// The tests of structure and walk would notice: each mistake planted in the shaders is found by
// them.
#include <array>
#include <string>
#include <vector>

#include "gpu/judge_views.h"
#include "gpu/structure_checks.h"
#include "oracle/analytic_scenes.h"
#include "shared/fault.h"
#include "support/test_device.h"

namespace viewloom {
namespace {

constexpr double kTolerance_px = 0.005;
constexpr double kVisitsMean_max = 16.0;

static_assert(abi::kFaultConstantId == kFaultConstantId);

// What the suite sees of a device.
struct Findings {
  Complaints complaints;    // of the structures
  oracle::Verdict verdict;  // of the walks
  double visits_mean = 0;   // on a smooth scene
};

void lookAtScene(WalkUnderTest& walk, const oracle::Scene& scene,
                 const std::vector<oracle::OutputView>& views, const std::string& name,
                 Findings& findings) {
  const std::unique_ptr<StructureSlot> slot = walk.build(*frameOf(scene));
  const oracle::OracleSource source = sourceOf(scene, *slot);
  const StructureImage image = walk.readBack(*slot);
  findings.complaints.add(checkStructure(image, source));
  findings.verdict.add(judgeViews(walk, *slot, source, views, kTolerance_px, name).verdict);
}

void lookFromAllSides(WalkUnderTest& walk, uint64_t seed, const oracle::Scene& scene,
                      Findings& findings) {
  oracle::Random random(seed);
  const auto views = oracle::randomViews(random, oracle::kViewKindCount, 13, 10);
  lookAtScene(walk, scene, views, "seed " + std::to_string(seed), findings);
}

// A pillar beside a wide board before it, and hills on both sides: rays pass between the two, and
// come out again behind the board, as the pillar is narrower than that.
void lookBetweenPillarAndBoard(WalkUnderTest& walk, Findings& findings) {
  oracle::Scene scene = oracle::planeScene({0, 0, 0.05}, 64, 16);
  for (int row = 0; row < 16; ++row) {
    for (int column = 28; column < 44; ++column) {
      scene.planes.at(0, column, row) = column < 32 ? 0.25f : 1.0f;
    }
  }
  oracle::OutputView view = oracle::ownView(scene);
  view.position_m.x = -0.3;
  lookAtScene(walk, scene, {view}, "pillar and board", findings);
}

Findings lookAt(const Device& device) {
  // One scene of each larger size, with one to four layers.
  constexpr std::array<uint64_t, 10> kSeeds = {12, 20, 21, 22, 27, 34, 35, 36, 49, 50};
  WalkUnderTest walk(device);
  Findings findings;
  for (const uint64_t seed : kSeeds) {
    lookFromAllSides(walk, seed, oracle::randomScene(seed), findings);
  }
  for (const uint64_t seed : {2, 3}) {
    lookFromAllSides(walk, seed, oracle::coarseScene(seed, 101, 40, 2), findings);
  }
  lookBetweenPillarAndBoard(walk, findings);

  // A pole over a smooth surface: a walk that descended at it has to climb again.
  oracle::Scene scene = oracle::smoothScene(256, 64, 1);
  for (int row = 0; row < 64; ++row) scene.planes.at(0, 128, row) = 1.5f;
  const std::unique_ptr<StructureSlot> slot = walk.build(*frameOf(scene));
  oracle::OutputView view = oracle::ownView(scene);
  view.position_m.x = -0.3;
  const TracedView traced = walk.trace(*slot, {view}, kTolerance_px).front();
  for (const abi::RayRecord& record : traced.records) findings.visits_mean += record.visits;
  findings.visits_mean /= double(traced.records.size());
  return findings;
}

enum class FoundBy { kStructure, kWalk, kVisits };

struct PlantedFault {
  uint32_t fault;
  const char* name;
  FoundBy found_by;
};

class PlantedFaultTest : public DeviceNeededTest,
                         public testing::WithParamInterface<PlantedFault> {};

TEST_P(PlantedFaultTest, isFound) {
  const Device device({.planted_fault = GetParam().fault});
  const Findings findings = lookAt(device);
  switch (GetParam().found_by) {
    case FoundBy::kStructure:
      EXPECT_FALSE(findings.complaints.empty());
      break;
    case FoundBy::kWalk:
      EXPECT_GT(findings.verdict.differing, 0u) << findings.verdict.summary();
      break;
    case FoundBy::kVisits:
      EXPECT_GT(findings.visits_mean, kVisitsMean_max);
      break;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Each, PlantedFaultTest,
    testing::Values(
        PlantedFault{abi::kFaultSlopeSign, "slopeSign", FoundBy::kStructure},
        PlantedFault{abi::kFaultCrossLinks, "crossLinks", FoundBy::kStructure},
        PlantedFault{abi::kFaultHoleIsSurface, "holeIsSurface", FoundBy::kStructure},
        PlantedFault{abi::kFaultBoxTooSmall, "boxTooSmall", FoundBy::kStructure},
        PlantedFault{abi::kFaultChildForgotten, "childForgotten", FoundBy::kStructure},
        PlantedFault{abi::kFaultErrorUnderstated, "errorUnderstated", FoundBy::kStructure},
        PlantedFault{abi::kFaultGapPassed, "gapPassed", FoundBy::kStructure},
        PlantedFault{abi::kFaultStepsFromInfinity, "stepsFromInfinity", FoundBy::kStructure},
        PlantedFault{abi::kFaultSlopeSign, "slopeSignInTheWalk", FoundBy::kWalk},
        PlantedFault{abi::kFaultCrossLinks, "crossLinksInTheWalk", FoundBy::kWalk},
        PlantedFault{abi::kFaultLayerDropped, "layerDropped", FoundBy::kWalk},
        PlantedFault{abi::kFaultPlaneOff, "planeOff", FoundBy::kWalk},
        PlantedFault{abi::kFaultNeverClimbs, "neverClimbs", FoundBy::kVisits},
        PlantedFault{abi::kFaultBehindIsHit, "behindIsHit", FoundBy::kWalk},
        PlantedFault{abi::kFaultLinks, "links", FoundBy::kWalk},
        PlantedFault{abi::kFaultEntryInFront, "entryInFront", FoundBy::kWalk},
        PlantedFault{abi::kFaultErrorIgnored, "errorIgnored", FoundBy::kWalk},
        PlantedFault{abi::kFaultFarSideEnds, "farSideEnds", FoundBy::kWalk},
        PlantedFault{abi::kFaultFarSideEndless, "farSideEndless", FoundBy::kWalk}),
    [](const testing::TestParamInfo<PlantedFault>& fault) { return fault.param.name; });

class NoFaultTest : public GpuTest {};

TEST_F(NoFaultTest, withoutAFaultNothingIsFound) {
  const Findings findings = lookAt(device());
  EXPECT_TRUE(findings.complaints.empty()) << findings.complaints.text();
  EXPECT_EQ(findings.verdict.differing, 0u) << findings.verdict.summary();
  EXPECT_LE(findings.visits_mean, kVisitsMean_max);
}

}  // namespace
}  // namespace viewloom
