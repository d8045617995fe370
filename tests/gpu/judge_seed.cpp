// SPDX-License-Identifier: Apache-2.0
#include "gpu/judge_seed.h"

#include <sstream>

namespace viewloom {
namespace {

constexpr double kTolerances_px[] = {0.25, 0.05, 0.01};

}  // namespace

std::string JudgedSeed::text() const {
  return scene + "\n" + complaints.text() + judged.summary();
}

JudgedSeed judgeSeed(WalkUnderTest& walk, uint64_t seed) {
  const oracle::Scene scene = oracle::randomScene(seed);
  const std::unique_ptr<StructureSlot> slot = walk.build(*frameOf(scene));
  const oracle::OracleSource source = sourceOf(scene, *slot);
  StructureImage image = walk.readBack(*slot);
  image.kappa_rel = scene.kappa.relative;

  const double tolerance_px = kTolerances_px[seed % 3];
  oracle::Random random(seed);
  JudgedViews judged;
  for (const int kind_count : {oracle::kViewKindCount, oracle::kInPlaneKindCount}) {
    const auto views = oracle::randomViews(random, kind_count, 13, 10);
    judged.add(judgeViews(walk, *slot, source, views, tolerance_px, "soak"));
  }
  std::ostringstream name;
  name << "seed " << seed << " " << scene.name << source.width() << "x" << source.height() << "x"
       << source.layerCount();
  return {name.str(), checkStructure(image, source), judged};
}

}  // namespace viewloom
