// SPDX-License-Identifier: Apache-2.0
#include "trace/band_parts.h"

#include <algorithm>

namespace viewloom {
namespace {

uint32_t perPart(uint64_t each_rays, uint32_t count_max) {
  return uint32_t(std::clamp<uint64_t>(kPartRays / std::max<uint64_t>(each_rays, 1), 1, count_max));
}

}  // namespace

BandParts::BandParts(const TraceJob& job, BandRows rows)
    : sample_rays_(uint64_t{job.layout->size_px.width} * rows.row_count * job.walk_count),
      sample_count_(job.gathers_on_host ? 1 : job.sample_count),
      row_count_(rows.row_count) {
  samples_per_part_ = job.reflects() ? 1 : perPart(sample_rays_, sample_count_);
  walk_count_ = (sample_count_ + samples_per_part_ - 1) / samples_per_part_;
  const uint64_t width_px = job.layout->size_px.width;
  if (job.reflects()) {
    row_rays_ =
        width_px * job.walk_count * job.reflection->bounce_count * job.reflection->sample_count;
    reflect_count_ = rowPartCount();
  } else if (job.mayGather()) {
    row_rays_ = width_px * job.layout->lens->gathered_count / kGatheredPerWalked;
    gather_count_ = rowPartCount();
  }
}

uint32_t BandParts::rowPartCount() {
  rows_per_part_ = perPart(row_rays_, row_count_);
  return (row_count_ + rows_per_part_ - 1) / rows_per_part_;
}

BandPart BandParts::at(uint32_t index) const {
  const uint32_t of_sample = 1 + reflect_count_;
  const bool is_gathered = index >= walk_count_ * of_sample;
  if (!is_gathered && index % of_sample == 0) {
    BandPart part{.first_sample = index / of_sample * samples_per_part_};
    part.end_sample = std::min(part.first_sample + samples_per_part_, sample_count_);
    part.ray_count = sample_rays_ * (part.end_sample - part.first_sample);
    return part;
  }
  const uint32_t row_part = is_gathered ? index - walk_count_ * of_sample : index % of_sample - 1;
  const uint32_t sample = is_gathered ? 0 : index / of_sample;
  BandPart part{.first_sample = sample,
                .end_sample = sample,
                .first_row = row_part * rows_per_part_,
                .reflects = !is_gathered};
  part.end_row = std::min(part.first_row + rows_per_part_, row_count_);
  part.ray_count = row_rays_ * (part.end_row - part.first_row);
  return part;
}

}  // namespace viewloom
