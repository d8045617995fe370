// SPDX-License-Identifier: Apache-2.0
#include "gpu/cube_beside_sources.h"

#include <utility>

#include <glm/geometric.hpp>

#include "gpu/cube_scenes.h"
#include "oracle/scene_generator.h"

namespace viewloom {
namespace {

// Anywhere around where it is, m, and turned.
void move(oracle::Random& random, double distance_m, double angle_rad, PosedScene& posed) {
  const auto part = [&] { return random.uniform(-1, 1); };
  const glm::dvec3 axis(part(), part(), part() + 0.01);
  posed.position_m += distance_m * glm::dvec3(part(), part(), part());
  posed.orientation = glm::angleAxis(angle_rad * part(), glm::normalize(axis)) * posed.orientation;
}

// Source with the picture of a face of the cube map, but for noise below the connection tolerance.
PosedScene pinholeOfFace(oracle::Random& random, const PosedScene& cube) {
  const int face = random.integer(0, oracle::kFaceCount - 1);
  PosedScene posed{.scene = faceOf(cube.scene, face),
                   .position_m = cube.position_m,
                   .orientation = cube.orientation * oracle::faceOrientation(face)};
  const float share = float(random.uniform(0.97, 1.03));
  for (float& inv_z : posed.scene.planes.inv_z) {
    if (inv_z > 0) inv_z *= share;
  }
  return posed;
}

std::vector<PosedScene> randomScenes(uint64_t seed, oracle::Random& random) {
  const int side = random.integer(3, 20), layer_count = random.integer(1, 3);
  PosedScene cube{.scene = randomCubeScene(random, seed, side, layer_count), .is_cube_map = true};
  if (random.chance(0.7)) move(random, 0.6, 3, cube);
  std::vector<PosedScene> scenes;
  const int count = random.integer(1, 2);
  for (int i = 0; i < count; ++i) {
    const bool is_same = random.chance(0.6);
    PosedScene posed = is_same ? pinholeOfFace(random, cube)
                               : PosedScene{.scene = oracle::randomScene(seed + uint64_t(i))};
    if (random.chance(is_same ? 0.4 : 0.8)) move(random, 0.6, 0.8, posed);
    scenes.push_back(std::move(posed));
  }
  scenes.insert(scenes.begin() + random.integer(0, count), std::move(cube));
  return scenes;
}

}  // namespace

oracle::Verdict judgeCubeBesideSources(SourcesUnderTest& tracer, uint64_t seed) {
  oracle::Random random(seed);
  const std::vector<PosedScene> scenes = randomScenes(seed, random);
  std::vector<oracle::OutputView> views =
      oracle::randomViews(random, oracle::kViewKindCount, 13, 10);
  // Some look anywhere, some from the place of a source.
  for (size_t i = 0; i < views.size(); ++i) {
    PosedScene eye{.position_m = views[i].position_m, .orientation = views[i].orientation};
    if (i % 3 == 0) move(random, 0, 3, eye);
    if (i % 4 == 3) eye.position_m = scenes[i / 4 % scenes.size()].position_m;
    views[i].position_m = eye.position_m;
    views[i].orientation = eye.orientation;
  }
  return judgeScenes(tracer, scenes, views,
                     {.tolerance_px = oracle::toleranceOfSeed_px(seed),
                      .is_half_float = seed % 2 == 0,
                      .name = "seed " + std::to_string(seed)});
}

}  // namespace viewloom
