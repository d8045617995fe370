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
      sample_count_(job.sample_count),
      row_count_(rows.row_count) {
  samples_per_part_ = perPart(sample_rays_, sample_count_);
  walk_count_ = (sample_count_ + samples_per_part_ - 1) / samples_per_part_;
  if (!job.mayGather()) return;
  row_rays_ =
      uint64_t{job.layout->size_px.width} * job.layout->lens->gathered_count / kGatheredPerWalked;
  rows_per_part_ = perPart(row_rays_, row_count_);
  gather_count_ = (row_count_ + rows_per_part_ - 1) / rows_per_part_;
}

BandPart BandParts::at(uint32_t index) const {
  BandPart part;
  if (index < walk_count_) {
    part.first_sample = index * samples_per_part_;
    part.end_sample = std::min(part.first_sample + samples_per_part_, sample_count_);
    part.ray_count = sample_rays_ * (part.end_sample - part.first_sample);
  } else {
    part.first_row = (index - walk_count_) * rows_per_part_;
    part.end_row = std::min(part.first_row + rows_per_part_, row_count_);
    part.ray_count = row_rays_ * (part.end_row - part.first_row);
  }
  return part;
}

}  // namespace viewloom
