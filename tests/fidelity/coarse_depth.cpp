// SPDX-License-Identifier: Apache-2.0
#include "fidelity/coarse_depth.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "oracle/scene_generator.h"

namespace viewloom::fidelity {
namespace {

template <typename Sample>
SharedBytes packed(const std::vector<Sample>& samples) {
  std::vector<uint8_t> bytes(samples.size() * sizeof(Sample));
  std::memcpy(bytes.data(), samples.data(), bytes.size());
  return std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
}

// 1/Z = disparity * scale + offset, for disparities of the set.
DepthFormat disparityFormat(const test::DataSet& set) {
  return {.meaning = DepthMeaning::kDisparity,
          .scale = 1 / (set.focal_px * set.baseline_m),
          .offset = set.inv_z_in_focus};
}

}  // namespace

CoarseDepth quantizedDepth(const test::DataSet& set, uint32_t code_count) {
  const auto [low, high] = std::minmax_element(set.disparity_px.begin(), set.disparity_px.end());
  const double step_px = (double{*high} - double{*low}) / (code_count - 1);
  std::vector<uint16_t> codes;
  CoarseDepth coarse = {.disparity_px = {},
                        .encoding = PlaneEncoding::kDepthU16,
                        .format = disparityFormat(set),
                        .samples = {}};
  for (const float disparity_px : set.disparity_px) {
    codes.push_back(uint16_t(std::lround((double{disparity_px} - double{*low}) / step_px)));
    coarse.disparity_px.push_back(float(double{*low} + codes.back() * step_px));
  }
  coarse.format.offset += *low * coarse.format.scale;
  coarse.format.scale *= step_px;
  coarse.samples = packed(codes);
  return coarse;
}

CoarseDepth noisyDepth(const test::DataSet& set, double sigma_px) {
  oracle::Random random(1);
  CoarseDepth coarse = {.disparity_px = set.disparity_px,
                        .encoding = PlaneEncoding::kDepthF32,
                        .format = disparityFormat(set),
                        .samples = {}};
  for (float& disparity_px : coarse.disparity_px) {
    const double noise_px = sigma_px * random.normal();
    const double inv_z = disparity_px * coarse.format.scale + coarse.format.offset;
    if (inv_z > 0) disparity_px += float(noise_px);
  }
  coarse.samples = packed(coarse.disparity_px);
  return coarse;
}

}  // namespace viewloom::fidelity
