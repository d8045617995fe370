// SPDX-License-Identifier: Apache-2.0
// Cube maps by definition (shaders/structure.md and walk.md, Cube maps): what surrounds each face,
// and what a ray through several of them answers.
#pragma once

#include <array>
#include <vector>

#include "oracle/view_generator.h"

namespace viewloom::oracle {

constexpr int kFaceCount = 6;
constexpr int kApron_px = 2;

// Planes of the faces, in their order, all of one size and as columns are kept.
using FacePlanes = std::array<InvZPlanes, kFaceCount>;

// The same, each with what its pinhole sees of its neighbours around it.
FacePlanes withAprons(const FacePlanes& faces);

// Face to cube.
glm::dquat faceOrientation(int face);
Pinhole facePinhole(int side_px);  // of a face with its apron

// Thread-safety: const methods may be called from any thread.
struct OracleCube {
  std::vector<OracleSource> faces;  // with their aprons
  std::vector<ConnectionTolerance> kappas;
  // Nearest 1/Z before smoothing, 1/m: rays begin a little before that.
  std::vector<double> nearest_inv_z;

  int sidePx() const { return faces.front().width() - 2 * kApron_px; }
};

struct CubeAnswer {
  RayClass ray_class = RayClass::kEmpty;
  double distance_m = 0;  // of the hit, along the ray
  int face = -1;          // that answers
  OracleHit hit;
};

// How a face's view of the ray may be moved: in px of the face, and in 1/Z.
struct FaceMove {
  int face = -1;  // none
  glm::dvec3 by{0.0};
};

CubeAnswer traceCube(const OracleCube& cube, const Ray& ray, const FaceMove& move = {});

// A ray of the cube's space as a face's camera has it.
ViewRay seenFromFace(int face, const ViewRay& ray);

}  // namespace viewloom::oracle
