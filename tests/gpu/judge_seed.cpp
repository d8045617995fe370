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

  oracle::Random random(seed);
  std::vector<oracle::OutputView> views;
  for (int kind = 0; kind < oracle::kViewKindCount; ++kind) {
    views.push_back(oracle::randomView(random, kind, 13, 10));
  }
  std::ostringstream name;
  name << "seed " << seed << " " << scene.name << source.width() << "x" << source.height() << "x"
       << source.layerCount();
  return {name.str(), checkStructure(image, source),
          judgeViews(walk, *slot, source, views, kTolerances_px[seed % 3], "soak")};
}

}  // namespace viewloom
