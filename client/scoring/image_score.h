// SPDX-License-Identifier: Apache-2.0
// How close a picture comes to the truth: PSNR, SSIM and FLIP over chosen pixels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "frame/size.h"
#include "scoring/score_transfer.h"

namespace viewloom {

// float[height][width][3], R G B in 0..1 in the transfer that is scored; top row first.
struct ScoredImage {
  SizePx size_px;
  std::vector<float> rgb;
};

struct ImageScore {
  uint64_t pixel_count = 0;
  double share = 0;    // of all pixels that were scored at all
  double psnr_db = 0;  // peak 1, mean over pixels and channels; +inf = identical, NaN = no pixel
  double ssim = 0;     // NaN = no pixel
  double flip = 0;     // mean; 0 = no visible difference, 1 = the largest; NaN = no pixel
};

// Scores pixels of two images of one size (at least 1x1). SSIM is that of Wang et al. 2004: 11x11
// Gaussian window of sigma 1.5, K1 = 0.01, K2 = 0.03, on BT.709 luma of the values as they are.
// Windows are cut off at the image's edge and weighted anew; they may reach over unselected pixels,
// as may those of FLIP (scoring/flip.h), which looks at the light.
class ImageComparison {
 public:
  ImageComparison(const ScoredImage& got, const ScoredImage& truth, ScoreTransfer transfer);

  // selected: uint8_t[height][width]; pixels other than 0 count. considered_count: pixels of which
  // `share` is the part selected.
  ImageScore score(std::span<const uint8_t> selected, uint64_t considered_count) const;

 private:
  SizePx size_px_;
  std::vector<double> squared_error_;  // [pixel], mean over the channels
  std::vector<double> ssim_;           // [pixel]
  std::vector<float> flip_;            // [pixel]
};

}  // namespace viewloom
