// SPDX-License-Identifier: Apache-2.0
#include "gpu/cube_under_test.h"

#include <glm/geometric.hpp>

#include "gpu/cube_scenes.h"
#include "oracle/scene_generator.h"

namespace viewloom {
namespace {

using oracle::kFaceCount;

// Some from the cube's own place, others from up to 0.8 m beside it; all turned anywhere.
std::vector<oracle::OutputView> viewsAround(oracle::Random& random) {
  std::vector<oracle::OutputView> views =
      oracle::randomViews(random, oracle::kViewKindCount, 13, 10);
  for (size_t i = 0; i < views.size(); ++i) {
    const auto part = [&] { return random.uniform(-1, 1); };
    const glm::dquat turn = glm::normalize(glm::dquat(part(), part(), part(), part()));
    views[i].position_m = turn * views[i].position_m;
    views[i].orientation = turn * views[i].orientation;
    if (i % 4 == 3) views[i].position_m = glm::dvec3(0.0);
  }
  return views;
}

}  // namespace

JudgedCube judgeCube(SourcesUnderTest& tracer, uint64_t seed) {
  const double tolerance_px = oracle::toleranceOfSeed_px(seed);
  oracle::Random random(seed);
  const int side = random.integer(3, 28), layer_count = random.integer(1, 4);
  const oracle::Scene scene = randomCubeScene(random, seed, side, layer_count);
  tracer.build(*frameOf({{.scene = scene, .is_cube_map = true}}, false));
  const oracle::OracleCube cube = oracleOf(scene, tracer.structure().parts());
  oracle::CubeJudge judge(cube, tolerance_px);
  JudgedCube judged;
  WalkUnderTest reader(tracer.device());
  for (size_t face = 0; face < size_t{kFaceCount}; ++face) {
    const StructureImage image = reader.readBack(*tracer.structure().parts()[face]);
    judged.complaints.add(checkStructure(image, cube.faces[face]));
  }
  const auto views = viewsAround(random);
  const std::vector<MergedView> traced = tracer.trace(views, tolerance_px);
  for (size_t v = 0; v < views.size(); ++v) {
    for (int px = 0; px < views[v].width * views[v].height; ++px) {
      const int column = px % views[v].width, row = px / views[v].width;
      const oracle::MergedAnswer& answer = traced[v].answers[size_t(px)];
      judge.consider(oracle::rayOf(views[v], column + 0.5, row + 0.5),
                     {answer.ray_class, answer.view_inv_z},
                     "seed " + std::to_string(seed) + " side " + std::to_string(side) + " layers " +
                         std::to_string(layer_count) + ", view " + views[v].name + " px (" +
                         std::to_string(column) + ", " + std::to_string(row) + ")");
    }
  }
  judged.verdict = judge.verdict();
  return judged;
}

}  // namespace viewloom
