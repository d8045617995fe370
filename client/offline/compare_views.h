// SPDX-License-Identifier: Apache-2.0
// Scores rendered views against true pictures, apart for what was seen and what had to be made up.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <vector>

#include "base/status.h"
#include "offline/truth_image.h"
#include "scoring/image_score.h"
#include "walk/offline_renderer.h"

namespace viewloom {

struct CompareOptions {
  std::filesystem::path truth;  // a TruthManifest
  ScoreTransfer transfer = ScoreTransfer::kSrgb;
  uint32_t border_px = 0;  // left out on every side of a view
  // For the true views in their order; see loadCoveredMask. None = the renderer's classes alone.
  std::vector<std::filesystem::path> covered_masks;
};

// [{"view", "by_renderer", "by_mask"}]: scores (scoreJson) by the renderer's own
// classes and, where there is one, by the given mask. Needs linear and mask.
absl::StatusOr<nlohmann::ordered_json> compareViews(const RenderedAtlas& atlas,
                                                    const CompareOptions& options);

// Scores in the form that commands print: {"covered", "hidden", "outside", "all"}, each with
// "pixels", "share", "psnr_db" (a number, "inf" for identical pictures, null without pixels),
// "ssim" and "flip" (null without pixels).
nlohmann::ordered_json scoreJson(const ClassScores& scores);

// One view of a rendered atlas, in the form it is scored in.
struct RenderedView {
  ScoredImage image;
  std::vector<PixelClass> classes;  // as the renderer says: covered are hits and known emptiness
};

// Needs linear and mask.
RenderedView cutView(const RenderedAtlas& atlas, uint32_t view, ScoreTransfer transfer);

}  // namespace viewloom
