// SPDX-License-Identifier: Apache-2.0
#include "gpu/cube_scenes.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "gpu/walk_under_test.h"
#include "oracle/smooth_planes.h"

namespace viewloom {
namespace {

using oracle::kFaceCount;

constexpr float kAbsoluteKappa = 0.02F;  // 1/m
constexpr float kRelativeKappa = 0.02F;  // where the tolerance is measured

// A surface all around, at a distance that varies smoothly by direction; by layer, further out.
class Surroundings {
 public:
  explicit Surroundings(oracle::Random& random) {
    for (glm::dvec3& wave : waves_) {
      wave = {random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 4)};
    }
    roughness_ = random.uniform(0, 0.3);
  }

  double distance_m(const glm::dvec3& direction, int layer) const {
    double sum = 0;
    for (const glm::dvec3& wave : waves_) sum += std::sin(glm::dot(wave, direction));
    return (1.5 + layer) * (1 + roughness_ * sum / double(std::size(waves_)));
  }
  // Patches of the nearer layers.
  bool isOpen(const glm::dvec3& direction, int layer) const {
    return std::sin(3 * glm::dot(waves_[size_t(layer)], direction)) > 0.2;
  }

 private:
  glm::dvec3 waves_[4];
  double roughness_ = 0;
};

oracle::FacePlanes smoothFaces(oracle::Random& random, int side, int layer_count) {
  const Surroundings around(random);
  oracle::FacePlanes faces;
  for (int face = 0; face < kFaceCount; ++face) {
    oracle::InvZPlanes& planes = faces[size_t(face)];
    planes = oracle::makePlanes(side, side, layer_count);
    for (int row = 0; row < side; ++row) {
      for (int column = 0; column < side; ++column) {
        const glm::dvec3 in_face((2 * column + 1.0) / side - 1, 1 - (2 * row + 1.0) / side, -1);
        const glm::dvec3 direction = glm::normalize(oracle::faceOrientation(face) * in_face);
        int place = 0;
        for (int layer = 0; layer < layer_count; ++layer) {
          if (layer + 1 < layer_count && around.isOpen(direction, layer)) continue;
          const double depth_m = around.distance_m(direction, layer) / glm::length(in_face);
          planes.at(place++, column, row) = float(1 / depth_m);
        }
      }
    }
  }
  return faces;
}

oracle::FacePlanes unrelatedFaces(uint64_t seed, int side, int layer_count) {
  oracle::FacePlanes faces;
  for (int face = 0; face < kFaceCount; ++face) {
    faces[size_t(face)] =
        oracle::randomScene(seed * kFaceCount + uint64_t(face), side, side, layer_count).planes;
  }
  return faces;
}

oracle::InvZPlanes stacked(const oracle::FacePlanes& faces) {
  const oracle::InvZPlanes& first = faces.front();
  oracle::InvZPlanes planes =
      oracle::makePlanes(first.width, kFaceCount * first.height, first.layer_count);
  for (int layer = 0; layer < planes.layer_count; ++layer) {
    for (int row = 0; row < planes.height; ++row) {
      for (int column = 0; column < planes.width; ++column) {
        planes.at(layer, column, row) =
            faces[size_t(row / first.height)].at(layer, column, row % first.height);
      }
    }
  }
  return planes;
}

}  // namespace

oracle::Scene randomCubeScene(oracle::Random& random, uint64_t seed, int side_px, int layer_count) {
  const oracle::FacePlanes faces = random.chance(0.5) ? smoothFaces(random, side_px, layer_count)
                                                      : unrelatedFaces(seed, side_px, layer_count);
  oracle::Scene cube{.planes = stacked(faces)};
  cube.kappa = random.chance(0.5) ? oracle::ConnectionTolerance{.absolute = kAbsoluteKappa}
                                  : oracle::ConnectionTolerance{.relative = kRelativeKappa};
  return cube;
}

oracle::Scene faceOf(const oracle::Scene& cube, int face) {
  const int side = cube.planes.width;
  oracle::Scene scene{.planes = oracle::makePlanes(side, side, cube.planes.layer_count),
                      .pinhole = {glm::dvec2(0.5 * side), glm::dvec2(0.5 * side)},
                      .kappa = cube.kappa};
  for (int layer = 0; layer < cube.planes.layer_count; ++layer) {
    for (int row = 0; row < side; ++row) {
      for (int column = 0; column < side; ++column) {
        scene.planes.at(layer, column, row) = cube.planes.at(layer, column, face * side + row);
      }
    }
  }
  return scene;
}

oracle::OracleCube oracleOf(const oracle::Scene& cube,
                            std::span<const StructureSlot* const> faces) {
  oracle::FacePlanes kept;
  oracle::OracleCube result;
  for (int face = 0; face < kFaceCount; ++face) {
    const SourceStats stats = faces[size_t(face)]->stats();
    kept[size_t(face)] = oracle::smoothedPlanes(oracle::canonicalPlanes(faceOf(cube, face).planes),
                                                {.reach = float(stats.smoothing_reach),
                                                 .step = float(stats.depth_step),
                                                 .sigma = float(stats.noise_sigma)});
    result.nearest_inv_z.push_back(stats.inv_z_max);
    result.kappas.push_back(kappaOf(cube, stats));
  }
  const oracle::FacePlanes whole = oracle::withAprons(kept);
  for (size_t face = 0; face < size_t{kFaceCount}; ++face) {
    result.faces.emplace_back(whole[face], oracle::facePinhole(kept[face].width),
                              result.kappas[face]);
  }
  return result;
}

}  // namespace viewloom
