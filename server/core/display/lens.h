// SPDX-License-Identifier: Apache-2.0
// A thin lens in front of every view: things out of focus are blurred.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "base/status.h"
#include "display/effects.h"

namespace viewloom {

struct AtlasLayout;
struct StreamDefaults;

// Lens in front of the views of a layout.
struct LensRays {
  double radius_m = 0;
  double focus_m = 0;  // distance from the display's eyes, along its axis
  uint32_t blades = 0;
  double rotation_rad = 0;
  uint32_t walked_count = 1;
  uint32_t gathered_count = 0;
  bool is_exact = false;

  uint32_t pointCount() const { return walked_count + gathered_count; }
};

// Lens for a layout. Empty if an automatic aperture has nothing to blur. FAILED_PRECONDITION if the
// lens needs a focal plane or a depth budget that the layout does not have.
absl::StatusOr<std::optional<LensRays>> lensRays(const LensSpec& lens, const AtlasLayout& layout,
                                                 const StreamDefaults& defaults);

// Pixels of a tile whose x and y are equal modulo this share their points on the lens.
inline constexpr uint32_t kLensPatternSide_px = 8;
inline constexpr uint32_t kLensPatternArea_px = kLensPatternSide_px * kLensPatternSide_px;

// Points where rays of each pixel of the pattern pass through a lens of radius 1, right and up:
// [point][pixel of the pattern, row by row].
//
// Points are those of Roberts' R2 sequence ("The Unreasonable Effectiveness of Quasirandom
// Sequences", 2018), moved by another vector for each pixel. Any few consecutive points of a pixel
// are spread evenly, and so is one point of each of 2x2, 4x4 and all pixels of the pattern. Nothing
// changes from frame to frame.
std::vector<glm::vec2> lensPoints(const LensRays& lens);

}  // namespace viewloom
