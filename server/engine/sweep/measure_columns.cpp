// SPDX-License-Identifier: Apache-2.0
#include "sweep/measure_columns.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "shared/histogram.h"

namespace viewloom {
namespace {

constexpr uint32_t kBlockPx = abi::kBlockPx;

// Within its bin as if samples were spread evenly.
float depthQuantile(const ColumnHistograms& histograms, const RangeHistogram& range, float share) {
  const float wanted = share * float(range.bounds.surface_count);
  if (wanted <= float(histograms.depth[0])) return 0;
  float below = float(range.bounds.below_count);
  for (uint32_t bin = 0; bin < range.counts.size(); ++bin) {
    const float here = float(range.counts[bin]);
    if (here > 0 && below + here >= wanted) {
      const float part = std::max(wanted - below, 0.0F) / here;
      return range.bounds.begin + (float(bin) + part) / range.bounds.bins_per_inv_z;
    }
    below += here;
  }
  return range.bounds.begin + float(range.counts.size()) / range.bounds.bins_per_inv_z;
}

// The end of the bin that holds the quantile, counted from bin `first`; without so many zeros.
float noiseQuantile(std::span<const uint32_t> bins, uint32_t first, float zero_count, float share) {
  const float total =
      float(std::accumulate(bins.begin() + first, bins.end(), uint64_t{0})) - zero_count;
  float below = -zero_count;
  for (uint32_t bin = first; bin < bins.size() && total > 0; ++bin) {
    below += float(bins[bin]);
    if (below < share * total) continue;
    return bin == 0 ? 0 : abi::binStart(bin + 1, abi::kNoiseMantissaBits);
  }
  return 0;
}

template <typename Counts>
void addTo(Counts& sums, const Counts& counts) {
  std::transform(sums.begin(), sums.end(), counts.begin(), sums.begin(), std::plus<>());
}

// Noise of surfaces: the sky is neither rounded nor noisy.
float surfaceSigma(const ColumnHistograms& histograms) {
  const float sky_count = float(std::min(histograms.depth[0], histograms.noise[0]));
  return noiseQuantile(histograms.noise, 0, sky_count, 0.5F) / abi::kMedianPerSigma;
}

}  // namespace

void ColumnHistograms::addBlockRow(const DepthColumns& columns, uint32_t block_row) {
  const SizePx size_px = columns.sizePx();
  const int y = int(std::min(block_row * kBlockPx + 2, size_px.height - 1));
  const float* const row = columns.row(0, y);
  const float* const above = columns.row(0, y - 1);
  const float* const below = columns.row(0, y + 1);
  for (uint32_t block = 0; block * kBlockPx < size_px.width; ++block) {
    const int x = int(std::min(block * kBlockPx + 2, size_px.width - 1));
    const bool is_along_x = ((block + block_row) & 1) == 0;
    const float before = is_along_x ? row[x - 1] : above[x];
    const float inv_z = row[x];
    const float after = is_along_x ? row[x + 1] : below[x];
    if (inv_z < 0) continue;
    ++depth[abi::depthBin(inv_z)];
    if (std::min(before, after) < 0) continue;
    const float difference = std::abs((after - inv_z) - (inv_z - before));
    ++noise[abi::noiseBin(abi::isLevel(difference, inv_z) ? 0 : difference)];
    const bool is_level = abi::isLevel(after - inv_z, inv_z) && abi::isLevel(inv_z - before, inv_z);
    changing_count += is_level ? 0 : 1;
  }
}

void ColumnHistograms::add(const ColumnHistograms& other) {
  addTo(depth, other.depth);
  addTo(noise, other.noise);
  changing_count += other.changing_count;
}

abi::RangeBounds settleRange(const ColumnHistograms& histograms) {
  const auto& depth = histograms.depth;
  const auto surface_count = std::accumulate(depth.begin(), depth.end(), uint32_t{0});
  uint32_t far_bin = 0, near_bin = 0, below_count = 0, count = 0;
  for (uint32_t bin = 0; bin < depth.size(); ++bin) {
    if (depth[bin] == 0) continue;
    if (float(count) < abi::kFarQuantile * float(surface_count)) {
      far_bin = bin;
      below_count = count;
    }
    if (float(count) < abi::kNearQuantile * float(surface_count)) near_bin = bin;
    count += depth[bin];
  }
  return abi::rangeBounds(far_bin, near_bin, below_count, surface_count);
}

void RangeHistogram::addBlockRow(const DepthColumns& columns, uint32_t block_row) {
  const SizePx size_px = columns.sizePx();
  const float* const row =
      columns.row(0, int(std::min(block_row * kBlockPx + 2, size_px.height - 1)));
  for (uint32_t block = 0; block * kBlockPx < size_px.width; ++block) {
    const float inv_z = row[std::min(block * kBlockPx + 2, size_px.width - 1)];
    const uint32_t bin = abi::rangeBin(inv_z, bounds);
    if (inv_z >= 0 && bin < counts.size()) ++counts[bin];
  }
}

void RangeHistogram::add(const RangeHistogram& other) {
  addTo(counts, other.counts);
}

MeasuredColumns settleColumns(const ColumnHistograms& histograms, const RangeHistogram& range,
                              const ColumnCounts& counts, uint32_t width_px, float given_kappa) {
  const auto quantile = [&](float share) { return depthQuantile(histograms, range, share); };
  const float inv_z_near = quantile(abi::kNearQuantile);
  const float inv_z_far = quantile(abi::kFarQuantile);
  const float inv_z_range = inv_z_near - inv_z_far;
  const auto bent_count =
      std::accumulate(histograms.noise.begin() + 1, histograms.noise.end(), uint32_t{0});
  const float step =
      abi::stepOfDepth(noiseQuantile(histograms.noise, 1, 0, abi::kStepQuantile), float(bent_count),
                       float(histograms.changing_count), inv_z_range);
  const float surface_sigma = surfaceSigma(histograms);
  const Smoothing smoothing = {
      .reach = abi::smoothingReach(step, noiseQuantile(histograms.noise, 1, 0, 0.5F), surface_sigma,
                                   inv_z_range, width_px),
      .first_pass = abi::firstSmoothingPass(step, surface_sigma)};
  const bool is_noisy = smoothing.reach > 0 && smoothing.first_pass > 0;
  const float sigma = std::max(noiseQuantile(histograms.noise, 0, 0, 0.5F) / abi::kMedianPerSigma,
                               is_noisy ? surface_sigma : 0);
  const bool is_given = given_kappa > 0;
  const float base = abi::baseOfSteps(inv_z_near, inv_z_far);
  const float measured_kappa =
      std::max({abi::leastStep(abi::kKappaRelative, inv_z_range), abi::kRoundingShare * inv_z_near,
                abi::kKappaSteps * step, abi::kKappaSigmas * sigma});
  const float kappa = is_given ? given_kappa : measured_kappa;
  const SurfaceSteps steps = {
      .kappa = {.least = kappa, .share = is_given ? 0 : abi::kKappaRelative, .from = base},
      // The step of one surface is not the step between two things.
      .deep = {.least = std::max(abi::leastStep(abi::kDeepStep, inv_z_range), kappa),
               .share = abi::kDeepStep,
               .from = base},
      .inv_z_range = inv_z_range};
  const bool has_surface = counts.inv_z_min <= counts.inv_z_max;
  return {.stats = {.depth_step = step,
                    .noise_sigma = sigma,
                    .connection_tolerance = steps.kappa.least,
                    .bad_samples_count = counts.bad_samples_count,
                    .unsorted_columns_count = counts.unsorted_columns_count,
                    .inv_z_min = has_surface ? counts.inv_z_min : 0.0F,
                    .inv_z_max = has_surface ? counts.inv_z_max : 0.0F,
                    .inv_z_near = inv_z_near,
                    .inv_z_far = inv_z_far,
                    .smoothing_reach = smoothing.reach},
          .depths =
              depthSpread(histograms.depth,
                          [](uint32_t bin) { return abi::binStart(bin, abi::kDepthMantissaBits); }),
          .steps = steps,
          .smoothing = smoothing};
}

}  // namespace viewloom
