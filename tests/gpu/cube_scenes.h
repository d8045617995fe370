// SPDX-License-Identifier: Apache-2.0
// Scenes around a cube map, and what the oracle sees of one that was built. Planes hold the faces
// one below the other, as a publisher sends them.
#pragma once

#include <span>

#include "oracle/cube_map.h"
#include "oracle/scene_generator.h"
#include "structure/structure_slot.h"

namespace viewloom {

// Cube map whose surroundings go on from face to face, or with a scene for every face.
oracle::Scene randomCubeScene(oracle::Random& random, uint64_t seed, int side_px, int layer_count);

// Content of a face, as a source of its own.
oracle::Scene faceOf(const oracle::Scene& cube, int face);

// With what the build measured of each face.
oracle::OracleCube oracleOf(const oracle::Scene& cube, std::span<const StructureSlot* const> faces);

}  // namespace viewloom
