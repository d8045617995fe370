// SPDX-License-Identifier: Apache-2.0
// Moves the pixels of a source into a view by the textbook: which pixels of the view can be known.
#pragma once

#include <cstdint>
#include <vector>

#include "frame/camera.h"
#include "frame/size.h"

namespace viewloom::test {

// inv_z: float[height][width], 1/m; 0 = infinitely far, negative = no surface.
struct InvZImage {
  SizePx size_px;
  std::vector<float> inv_z;
};

// Every source pixel that has a surface is moved, as a point, to the pixel of the view that it
// falls into; of several the nearest stays. Returns 1/Z in the view, negative where no source pixel
// falls. `view`: its pose relative to the source, which stands at the origin.
InvZImage forwardMap(const InvZImage& source, const Intrinsics& source_camera, const Camera& view,
                     SizePx view_size_px);

// 255 where the map is known, 0 elsewhere: what `viewloom render --covered-mask` takes.
std::vector<uint8_t> coveredMask(const InvZImage& mapped);

}  // namespace viewloom::test
