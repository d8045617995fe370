// SPDX-License-Identifier: Apache-2.0
#include "inspect/measure_depth.h"

#include <algorithm>
#include <cmath>

#include "shared/histogram.h"

namespace viewloom::inspect {
namespace {

// Reorders the values. 0 without any.
float quantile(std::vector<float>& values, float share) {
  if (values.empty()) return 0;
  const auto rank = static_cast<size_t>(share * static_cast<float>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank),
                   values.end());
  return values[rank];
}

class Columns {
 public:
  explicit Columns(const DepthSamples& samples) : samples_(samples) {}

  // kNoSurface around the image.
  float at(int64_t x, int64_t y) const {
    if (x < 0 || y < 0 || x >= samples_.width_px || y >= samples_.height_px) return kNoSurface;
    return samples_.inv_z[static_cast<size_t>(y) * samples_.width_px + static_cast<size_t>(x)];
  }

 private:
  const DepthSamples& samples_;
};

struct Differences {
  std::vector<float> all;  // |second differences|, of surfaces nearer than infinity
  std::vector<float> not_zero;
  uint64_t changing_count = 0;  // where depth is not the same in all three px
};

// The same differences as in shaders/structure/measure_depth.comp.
Differences secondDifferences(const DepthSamples& samples) {
  const Columns columns(samples);
  Differences differences;
  constexpr int64_t kBlock = abi::kBlockPx;
  for (int64_t block_y = 0; block_y * kBlock < samples.height_px; ++block_y) {
    const int64_t y = std::min<int64_t>(block_y * kBlock + 2, samples.height_px - 1);
    for (int64_t block_x = 0; block_x * kBlock < samples.width_px; ++block_x) {
      const int64_t x = std::min<int64_t>(block_x * kBlock + 2, samples.width_px - 1);
      const int64_t along_x = ((block_x + block_y) & 1) == 0 ? 1 : 0;
      const int64_t along_y = 1 - along_x;
      const float before = columns.at(x - along_x, y - along_y);
      const float here = columns.at(x, y);
      const float after = columns.at(x + along_x, y + along_y);
      if (!(std::min({before, here, after}) >= 0) || here == 0) continue;
      const float difference = std::abs((after - here) - (here - before));
      const bool is_none = abi::isLevel(difference, here);
      if (!abi::isLevel(after - here, here) || !abi::isLevel(here - before, here)) {
        ++differences.changing_count;
      }
      differences.all.push_back(is_none ? 0 : difference);
      if (!is_none) differences.not_zero.push_back(difference);
    }
  }
  return differences;
}

}  // namespace

DepthMeasures measureDepth(const DepthSamples& samples) {
  std::vector<float> surfaces;
  surfaces.reserve(samples.surface_count);
  std::copy_if(samples.inv_z.begin(), samples.inv_z.end(), std::back_inserter(surfaces),
               [](float inv_z) { return inv_z > 0; });
  Differences differences = secondDifferences(samples);
  return {.inv_z_min = quantile(surfaces, 0),
          .inv_z_median = quantile(surfaces, 0.5F),
          .inv_z_max = quantile(surfaces, 1),
          .inv_z_far = quantile(surfaces, abi::kFarQuantile),
          .inv_z_near = quantile(surfaces, abi::kNearQuantile),
          .step = quantile(differences.not_zero, abi::kStepQuantile),
          .noise_sigma = quantile(differences.all, 0.5F) / abi::kMedianPerSigma,
          .difference_median = quantile(differences.not_zero, 0.5F),
          .changing_count = differences.changing_count,
          .bent_count = differences.not_zero.size()};
}

float medianIn(const DepthSamples& samples, const ImageArea& area) {
  // Rounded, so that areas at opposite rims have the same size.
  const auto at = [](double share, uint32_t side_px) {
    return static_cast<size_t>(std::lround(share * side_px));
  };
  std::vector<float> surfaces;
  for (size_t y = at(area.top, samples.height_px); y < at(area.bottom, samples.height_px); ++y) {
    for (size_t x = at(area.left, samples.width_px); x < at(area.right, samples.width_px); ++x) {
      const float inv_z = samples.inv_z[y * samples.width_px + x];
      if (inv_z >= 0) surfaces.push_back(inv_z);
    }
  }
  return surfaces.empty() ? kNoSurface : quantile(surfaces, 0.5F);
}

}  // namespace viewloom::inspect
