// SPDX-License-Identifier: Apache-2.0
// Says whether what a cube map answered differs from the oracle's answer: only where no moved ray
// or surface could excuse it.
#pragma once

#include <string>
#include <vector>

#include "oracle/cube_map.h"
#include "oracle/judge.h"

namespace viewloom::oracle {

struct TestedCubeAnswer {
  RayClass ray_class = RayClass::kEmpty;
  double view_inv_z = 0;  // of a hit
};

// Thread-safety: none.
class CubeJudge {
 public:
  CubeJudge(const OracleCube& cube, double output_px);

  // `ray`: in the cube's space, its direction one metre along the view's axis long.
  void consider(const ViewRay& ray, const TestedCubeAnswer& tested, const std::string& where);
  const Verdict& verdict() const { return verdict_; }

 private:
  std::vector<CubeAnswer> answersNearby(const ViewRay& ray, const TestedCubeAnswer& tested) const;

  const OracleCube& cube_;
  const double output_px_;
  std::vector<JudgeTolerance> tolerances_;  // by face
  Verdict verdict_;
};

}  // namespace viewloom::oracle
