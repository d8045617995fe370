// SPDX-License-Identifier: Apache-2.0
// Which faces of a cube map an atlas looks at.
#pragma once

#include <span>

#include "frame/size.h"
#include "shared/trace_abi.h"

namespace viewloom {

// Whether some ray of these tiles may enter a face whose largest inv_z is this, 1/m; false only
// where none does. `size_px`: of the face with its apron.
bool raysMayEnterFace(std::span<const abi::ViewParams> tiles, SizePx tile_px, SizePx size_px,
                      double inv_z_max);

}  // namespace viewloom
