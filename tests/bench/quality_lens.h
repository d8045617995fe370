// SPDX-License-Identifier: Apache-2.0
// Value of a lens: its picture beside one of many exact rays, and its cost.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "display/lens.h"
#include "frame/size.h"
#include "gpu/device.h"
#include "walk/offline_renderer.h"

namespace viewloom::bench {

// How a view is seen through the lens.
struct LensWay {
  uint32_t layer_count = 1;  // of the source
  uint32_t walked_count = 1;
  uint32_t gathered_count = 0;
  bool is_exact = false;
};

struct LensScore {
  LensWay way;
  double psnr_db = 0;          // sRGB, of all px that the source can show
  double hidden_psnr_db = 0;   // the same of px much of whose light only deeper layers hold
  double hidden_px_share = 0;  // how many of all those are
  double mean_error = 0;       // signed, of linear light; 0..1
  double level_db = 0;         // all of the light, beside what is true
  double seams = 0;       // steps of the error between blocks of px, beside those inside: 1 is none
  double trace_ms = 0;    // median
  double pinhole_ms = 0;  // the same of the view without a lens, traced in turn with it
};

struct LensScoring {
  uint32_t source_width_px = 960;
  uint32_t view_width_px = 320;
  uint32_t true_ray_count = 1024;  // a px; 0: what it is worth is not asked
  uint32_t round_count = 11;       // of each trace, for the median; 0: what it costs is not
  double radius_m = 0.02;          // of the lens
  double aside_m = 0;              // of the view, to the right of the source
};

// The cluttered room, in focus at a third of its depth. The renderer gathers lenses where it does.
std::vector<LensScore> lensScores(OfflineRenderer& renderer, const LensScoring& scoring,
                                  const std::vector<LensWay>& ways);

nlohmann::ordered_json qualityOfLens(const Device& device);

}  // namespace viewloom::bench
