// SPDX-License-Identifier: Apache-2.0
// viewloom and its rivals against the true views of a set, all by one mask.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fidelity/coarse_depth.h"
#include "fidelity/rivals.h"
#include "walk/offline_renderer.h"

namespace viewloom::fidelity {

// A set and how it is scored.
struct Trial {
  test::DataSet set;
  ScoreTransfer transfer = ScoreTransfer::kSrgb;
  uint32_t border_px = 0;                            // left out on every side
  double cut_px = 0;                                 // of the mask, which knows the true depth
  double mesh_cut_px = 0;                            // of the cut mesh
  std::optional<CoarseDepth> coarse = std::nullopt;  // given in place of the set's depth
};
// Both sets as they are, then each with coarser depth and the outermost view alone.
// Throws std::runtime_error when the files under `data` cannot be read.
std::vector<Trial> loadTrials(const std::filesystem::path& data);

struct MethodReport {
  std::string method;
  std::vector<ClassScores> by_mask;  // [view], in the set's order
  // See fidelity/flicker.h: of the views in one row with the source, and in one column.
  double row_flicker = 0;
  std::optional<double> column_flicker;
};

struct TrialReport {
  std::vector<MethodReport> methods;        // viewloom's first
  std::vector<ClassScores> by_own_classes;  // [view], viewloom's, by what it says it knows
};

TrialReport runTrial(OfflineRenderer& renderer, const Trial& trial);

}  // namespace viewloom::fidelity
