// SPDX-License-Identifier: Apache-2.0
// Which faces of a cube map an atlas looks at.
#pragma once

#include "frame/size.h"
#include "picture/trace_job.h"

namespace viewloom {

// Whether some of these rays may enter a face whose largest inv_z is this, 1/m; false only where
// none does. `size_px`: of the face with its apron.
bool raysMayEnterFace(const TileRays& rays, SizePx size_px, double inv_z_max);

}  // namespace viewloom
