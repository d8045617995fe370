// SPDX-License-Identifier: Apache-2.0
// How close a picture comes to the truth: PSNR, SSIM and FLIP over chosen pixels, and apart for
// what the source knows and what had to be made up.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "base/srgb.h"
#include "frame/size.h"

namespace viewloom {

// How light becomes the numbers that are compared.
enum class ScoreTransfer : uint8_t { kSrgb, kGamma22 };

// An sRGB-encoded sample (0..1) in the transfer that is scored, and what is scored as light.
inline float scoredSample(float srgb_encoded, ScoreTransfer transfer) {
  if (transfer == ScoreTransfer::kSrgb) return srgb_encoded;
  return static_cast<float>(std::pow(std::max(linearFromSrgb(srgb_encoded), 0.0), 1 / 2.2));
}
inline double linearFromScored(double scored, ScoreTransfer transfer) {
  return transfer == ScoreTransfer::kSrgb ? linearFromSrgb(scored) : std::pow(scored, 2.2);
}

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

// Whether a pixel of a view can be known from the source: covered by what it shows, hidden behind
// that, or outside its image.
enum class PixelClass : uint8_t { kHidden, kOutside, kCovered };

struct ClassScores {
  ImageScore covered;
  ImageScore hidden;
  ImageScore outside;
  ImageScore all;
};

// classes: PixelClass[height][width] of the pictures compared.
ClassScores scoreByClass(const ImageComparison& comparison, std::span<const PixelClass> classes);

}  // namespace viewloom
