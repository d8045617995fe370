// SPDX-License-Identifier: Apache-2.0
// Writes a rendered atlas as PNG files: the atlas, its views, how rays ended and what they cost.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/status.h"
#include "walk/offline_renderer.h"

namespace viewloom {

// Ray class k of the mask is grey 51 * k: padding 0, hit 51, assumed 102, hidden 153, outside 204,
// empty 255.
inline constexpr uint8_t kGreyPerRayClass = 51;

struct VisitStats {
  double mean = 0;
  uint32_t p99 = 0;
  uint32_t max = 0;
};

// Over the rays, without padding. Needs visits and mask.
VisitStats visitStats(const RenderedAtlas& atlas);

// atlas<suffix>.png, view_<index>.png, mask.png and visits.png (black, red, yellow, white; white is
// the 99th percentile). Returns the names of the files. Needs visits and mask.
absl::StatusOr<std::vector<std::string>> writeAtlasPictures(const RenderedAtlas& atlas,
                                                            const std::filesystem::path& folder);

}  // namespace viewloom
