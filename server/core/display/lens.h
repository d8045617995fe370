// SPDX-License-Identifier: Apache-2.0
// A thin lens in front of every view: what is not in focus is blurred, as by a camera's opening.
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

// A lens before the views of a layout.
struct LensRays {
  double radius_m = 0;
  double focus_m = 0;  // in front of the display's eyes, along its axis
  uint32_t blades = 0;
  double rotation_rad = 0;
  uint32_t walked_count = 1;
  uint32_t gathered_count = 0;
  bool is_exact = false;

  uint32_t pointCount() const { return walked_count + gathered_count; }
};

// Nothing where an automatic aperture has nothing to blur. FAILED_PRECONDITION for a layout that
// has no focal plane, or no depth budget, where the lens leaves that to it.
absl::StatusOr<std::optional<LensRays>> lensRays(const LensSpec& lens, const AtlasLayout& layout,
                                                 const StreamDefaults& defaults);

// Px of a tile whose x and whose y are equal modulo this share their points on the lens.
inline constexpr uint32_t kLensPatternSide_px = 8;
inline constexpr uint32_t kLensPatternArea_px = kLensPatternSide_px * kLensPatternSide_px;

// Where the rays of each px of the pattern pass through a lens of radius 1, to the right and up:
// [point][px of the pattern, row by row]. Points are those of Roberts' R2 sequence ("The
// Unreasonable Effectiveness of Quasirandom Sequences", 2018), moved for each px by a vector of its
// own: any few neighbours among the points of a px are spread evenly, and so is one point of 2x2,
// of 4x4 and of all px of the pattern. All stay the same from frame to frame.
std::vector<glm::vec2> lensPoints(const LensRays& lens);

}  // namespace viewloom
