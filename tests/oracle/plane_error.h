// SPDX-License-Identifier: Apache-2.0
// By how much the planes that a tracer may take for facets may be off.
#pragma once

#include <vector>

#include "oracle/view_generator.h"

namespace viewloom::oracle {

// A pinhole with its facets and their connection tolerance: a source, or a face of a cube map.
struct SeenFacets {
  const OracleSource* source = nullptr;
  ConnectionTolerance kappa;
};

// 1/m, where the pinhole sees places along a ray, 1/Z of the view: of them all the largest; 0 where
// it sees none. Half of the connection tolerance, or what moves the picture by `output_px`. `seen`:
// the ray as the pinhole has it, its direction one metre along the view's axis long.
double planeErrorAt(const SeenFacets& facets, const ViewRay& seen,
                    const std::vector<double>& view_inv_zs, double output_px);

}  // namespace viewloom::oracle
