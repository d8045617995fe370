// SPDX-License-Identifier: Apache-2.0
#include "gpu/judge_seed.h"

#include <sstream>

#include "oracle/scene_generator.h"

namespace viewloom {
namespace {

std::string describe(uint64_t seed, const oracle::Scene& scene,
                     const oracle::OracleSource& source) {
  std::ostringstream text;
  text << "seed " << seed << " " << scene.name << source.width() << "x" << source.height() << "x"
       << source.layerCount();
  return text.str();
}

}  // namespace

std::string JudgedSeed::text() const {
  return scene + "\n" + complaints.text() + judged.summary();
}

JudgedSeed judgeSeed(WalkUnderTest& walk, uint64_t seed) {
  const oracle::Scene scene = oracle::randomScene(seed);
  const std::unique_ptr<StructureSlot> slot = walk.build(*frameOf(scene));
  const oracle::OracleSource source = sourceOf(scene, *slot);
  const StructureImage image = walk.readBack(*slot);

  const double tolerance_px = oracle::toleranceOfSeed_px(seed);
  oracle::Random random(seed);
  JudgedViews judged;
  for (const int kind_count : {oracle::kViewKindCount, oracle::kInPlaneKindCount}) {
    const auto views = oracle::randomViews(random, kind_count, 13, 10);
    judged.add(judgeViews(walk, *slot, source, views, tolerance_px, "soak"));
  }
  return {describe(seed, scene, source), checkStructure(image, source), judged};
}

JudgedSeed judgeSweptSeed(SweepUnderTest& sweep, uint64_t seed) {
  const oracle::Scene scene = oracle::randomScene(seed);
  oracle::Random random(seed);
  std::vector<oracle::OutputView> views;
  for (int i = 0; i < 3; ++i) views.push_back(oracle::randomView(random, 0, 24, 18));
  sweep.prepare(frameOf(scene));
  const oracle::OracleSource source = sourceOf(scene, sweep.source().measured().stats);
  const double tolerance_px = oracle::toleranceOfSeed_px(seed);
  return {describe(seed, scene, source), Complaints(),
          judgeTraced(sweep.trace(views, tolerance_px), source, views, tolerance_px, "soak")};
}

}  // namespace viewloom
