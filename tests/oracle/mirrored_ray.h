// SPDX-License-Identifier: Apache-2.0
// The ray that a surface of a source sends on, by the definition in shaders/reflections.md.
#pragma once

#include "oracle/projected_ray.h"

namespace viewloom::oracle {

// A place on a surface.
struct MirrorSpot {
  FacetAt facet;
  double x_px = 0;
  double y_px = 0;
  double inv_z = 0;  // 1/m
};

// In the surface of the column that is nearest to a place; that column holds one.
MirrorSpot mirrorSpotAt(const OracleSource& source, double x_px, double y_px, double inv_z);

struct MirrorTolerance {
  double moved_rad = 0;  // by which an error may move what an eye sees
  double measured = 0;   // a step of the depth samples, or 4 sigmas of their noise, 1/m
  double rounding = 0;   // 1/m
};

struct MirroredRay {
  Ray ray;
  bool is_bent = false;  // along the facet, below which it would have gone
};

// Reflection of a ray from an eye (m, the source's camera space), by the surface's own slopes. It
// starts in front of the surface by the allowed error, seen from the eye behind the mirror.
MirroredRay mirrored(const OracleSource& source, const MirrorSpot& spot, const glm::dvec3& eye_m,
                     const MirrorTolerance& tolerance);

}  // namespace viewloom::oracle
