// SPDX-License-Identifier: Apache-2.0
#include "trace/band_parts.h"

#include <algorithm>
#include <utility>

#include "shared/trace_abi.h"
#include "trace/met_blocks.h"

namespace viewloom {

BandParts::BandParts(const TraceJob& job, BandRows rows)
    : walked_row_rays_(uint64_t{job.layout->size_px.width} * job.walk_count),
      sample_count_(job.gathers_on_host ? 1 : job.sample_count),
      row_count_(rows.row_count),
      width_px_(job.layout->size_px.width),
      reflects_(job.reflects()),
      gathers_(!reflects_ && job.mayGather()) {
  const uint64_t width_px = width_px_;
  if (reflects_) {
    row_rays_ =
        width_px * job.walk_count * job.reflection->bounce_count * job.reflection->sample_count;
  } else if (gathers_) {
    row_rays_ = width_px * job.layout->lens->gathered_count / kGatheredPerWalked;
  }
}

BandPart BandParts::take(uint64_t ray_count_max) {
  const bool takes_samples = kind_ == PartKind::kWalk && row_ == 0 && !reflects_;
  const uint64_t sample_rays = rowRays() * row_count_;
  const bool takes_columns = kind_ != PartKind::kWalk && (column_ > 0 || ray_count_max < rowRays());
  BandPart part = takes_samples && (ray_count_max >= sample_rays || isWhole(sample_))
                      ? takeSamples(ray_count_max)
                  : takes_columns ? takeColumns(ray_count_max)
                                  : takeRows(ray_count_max);
  part.kind = kind_;
  part.is_first = std::exchange(is_first_, false);
  part.ray_count = rowRays() * (part.end_row - part.first_row) *
                   (part.end_column - part.first_column) / width_px_;
  if (part.walks()) part.ray_count *= part.end_sample - part.first_sample;
  goOnFrom(part);
  part.is_last = is_over_;
  part.ends_band = row_ == 0 && column_ == 0;
  return part;
}

// Whether blocks of px are left out of it.
bool BandParts::isWhole(uint32_t sample) const {
  return gathers_ && metRound(sample, sample_count_).first > 0;
}

uint64_t BandParts::rowRays() const {
  return std::max<uint64_t>(kind_ == PartKind::kWalk ? walked_row_rays_ : row_rays_, 1);
}

BandPart BandParts::takeSamples(uint64_t ray_count_max) {
  const uint64_t count = std::max<uint64_t>(ray_count_max / (rowRays() * row_count_), 1);
  return {.first_sample = sample_,
          .end_sample = uint32_t(std::min<uint64_t>(sample_ + count, sample_count_)),
          .end_row = row_count_,
          .end_column = width_px_};
}

BandPart BandParts::takeRows(uint64_t ray_count_max) {
  const uint64_t count = std::max<uint64_t>(ray_count_max / rowRays(), 1);
  return {.first_sample = sample_,
          .end_sample = kind_ == PartKind::kWalk ? sample_ + 1 : sample_,
          .first_row = row_,
          .end_row = uint32_t(std::min<uint64_t>(row_ + count, row_count_)),
          .end_column = width_px_};
}

// In whole groups of one row.
BandPart BandParts::takeColumns(uint64_t ray_count_max) {
  const uint64_t group_rays = rowRays() * abi::kTraceGroupSize / width_px_;
  const uint64_t groups =
      std::clamp<uint64_t>(ray_count_max / std::max<uint64_t>(group_rays, 1), 1, width_px_);
  const uint64_t end = column_ + groups * abi::kTraceGroupSize;
  return {.first_sample = sample_,
          .end_sample = sample_,
          .first_row = row_,
          .end_row = row_ + 1,
          .first_column = column_,
          .end_column = uint32_t(std::min<uint64_t>(end, width_px_))};
}

void BandParts::goOnFrom(const BandPart& part) {
  column_ = part.end_column % width_px_;
  row_ = part.end_row - (column_ > 0 ? 1 : 0);
  if (row_ < row_count_) return;
  row_ = 0;
  if (kind_ == PartKind::kWalk && reflects_) {
    kind_ = PartKind::kReflect;
    return;
  }
  if (kind_ == PartKind::kReflect) kind_ = PartKind::kWalk;
  if (kind_ == PartKind::kGather) {
    is_over_ = true;
    return;
  }
  sample_ = std::max(part.end_sample, sample_ + (reflects_ ? 1 : 0));
  if (sample_ < sample_count_) return;
  if (gathers_) {
    kind_ = PartKind::kGather;
    sample_ = 0;
  } else {
    is_over_ = true;
  }
}

}  // namespace viewloom
