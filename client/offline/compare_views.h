// SPDX-License-Identifier: Apache-2.0
// Scores rendered views against true pictures, apart for what was seen and what had to be made up.
#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/status.h"
#include "offline/truth_image.h"
#include "walk/offline_renderer.h"

namespace viewloom {

struct CompareOptions {
  std::filesystem::path truth;  // a TruthManifest
  ScoreTransfer transfer = ScoreTransfer::kSrgb;
  uint32_t border_px = 0;  // left out on every side of a view
  // For the true views in their order; see loadCoveredMask. None = the renderer's classes alone.
  std::vector<std::filesystem::path> covered_masks;
};

// [{"view", "by_renderer", "by_mask"}]: scores (offline/score_json.h) by the renderer's own
// classes and, where there is one, by the given mask. Needs linear and mask.
absl::StatusOr<nlohmann::ordered_json> compareViews(const RenderedAtlas& atlas,
                                                    const CompareOptions& options);

}  // namespace viewloom
