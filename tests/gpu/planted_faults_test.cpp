// SPDX-License-Identifier: Apache-2.0
// The tests of structure and walk would notice: each mistake planted in the shaders is found by
// them.
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "gpu/judge_views.h"
#include "gpu/structure_checks.h"
#include "oracle/analytic_scenes.h"
#include "shared/fault.h"
#include "support/test_device.h"

namespace viewloom::planted_faults_test {
namespace {

constexpr double kTolerance_px = 0.005;
constexpr double kVisitsMean_max = 16.0;

static_assert(abi::kFaultConstantId == kFaultConstantId);

struct LookedAt {
  std::string name;
  oracle::Scene scene;
  std::vector<oracle::OutputView> views;
};

LookedAt fromAllSides(uint64_t seed, oracle::Scene scene) {
  oracle::Random random(seed);
  return {"seed " + std::to_string(seed), std::move(scene),
          oracle::randomViews(random, oracle::kViewKindCount, 13, 10)};
}

// A pillar beside a wide board before it, and hills on both sides: rays pass between the two, and
// come out again behind the board, as the pillar is narrower than that.
LookedAt betweenPillarAndBoard() {
  oracle::Scene scene = oracle::planeScene({0, 0, 0.05}, 64, 16);
  for (int row = 0; row < 16; ++row) {
    for (int column = 28; column < 44; ++column) {
      scene.planes.at(0, column, row) = column < 32 ? 0.25f : 1.0f;
    }
  }
  oracle::OutputView view = oracle::ownView(scene);
  view.position_m.x = -0.3;
  return {"pillar and board", scene, {view}};
}

std::vector<LookedAt> everythingLookedAt() {
  // One scene of each larger size, with one to four layers.
  constexpr std::array<uint64_t, 10> kSeeds = {12, 20, 21, 22, 27, 34, 35, 36, 49, 50};
  std::vector<LookedAt> all;
  for (const uint64_t seed : kSeeds) all.push_back(fromAllSides(seed, oracle::randomScene(seed)));
  for (const uint64_t seed : {2, 3}) {
    all.push_back(fromAllSides(seed, oracle::coarseScene(seed, 101, 40, 2)));
  }
  all.push_back(betweenPillarAndBoard());
  return all;
}

// Complaints about the first structure that has some. Compiles no kernel of the walk.
Complaints firstComplaints(WalkUnderTest& walk) {
  for (const LookedAt& looked_at : everythingLookedAt()) {
    const std::unique_ptr<StructureSlot> slot = walk.build(*frameOf(looked_at.scene));
    const Complaints complaints =
        checkStructure(walk.readBack(*slot), sourceOf(looked_at.scene, *slot));
    if (!complaints.empty()) return complaints;
  }
  return {};
}

// Verdict on all walks up to the first scene where one differs from the oracle's.
oracle::Verdict verdictOfWalks(WalkUnderTest& walk) {
  oracle::Verdict verdict;
  for (const LookedAt& looked_at : everythingLookedAt()) {
    const std::unique_ptr<StructureSlot> slot = walk.build(*frameOf(looked_at.scene));
    const oracle::OracleSource source = sourceOf(looked_at.scene, *slot);
    verdict.add(
        judgeViews(walk, *slot, source, looked_at.views, kTolerance_px, looked_at.name).verdict);
    if (verdict.differing > 0) break;
  }
  return verdict;
}

// With a pole over a smooth surface: a walk that descended at it has to climb again.
double meanVisits(WalkUnderTest& walk) {
  oracle::Scene scene = oracle::smoothScene(256, 64, 1);
  for (int row = 0; row < 64; ++row) scene.planes.at(0, 128, row) = 1.5f;
  const std::unique_ptr<StructureSlot> slot = walk.build(*frameOf(scene));
  oracle::OutputView view = oracle::ownView(scene);
  view.position_m.x = -0.3;
  const TracedView traced = walk.trace(*slot, {view}, kTolerance_px).front();
  double visits = 0;
  for (const abi::RayRecord& record : traced.records) visits += record.visits;
  return visits / double(traced.records.size());
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
  WalkUnderTest walk(device);
  switch (GetParam().found_by) {
    case FoundBy::kStructure:
      EXPECT_FALSE(firstComplaints(walk).empty());
      break;
    case FoundBy::kWalk: {
      const oracle::Verdict verdict = verdictOfWalks(walk);
      EXPECT_GT(verdict.differing, 0u) << verdict.summary();
      break;
    }
    case FoundBy::kVisits:
      EXPECT_GT(meanVisits(walk), kVisitsMean_max);
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
  auto& walk = shared<WalkUnderTest>();
  const Complaints complaints = firstComplaints(walk);
  EXPECT_TRUE(complaints.empty()) << complaints.text();
  const oracle::Verdict verdict = verdictOfWalks(walk);
  EXPECT_EQ(verdict.differing, 0u) << verdict.summary();
  EXPECT_LE(meanVisits(walk), kVisitsMean_max);
}

}  // namespace
}  // namespace viewloom::planted_faults_test
