// SPDX-License-Identifier: Apache-2.0
#include "trace/band_parts.h"

#include <algorithm>
#include <utility>

#include "shared/lens_abi.h"
#include "shared/trace_abi.h"
#include "trace/met_blocks.h"

namespace viewloom {

static_assert(kWalkColumns_px % abi::kTraceGroupSize == 0);

BandParts::BandParts(const TraceJob& job, BandRows rows, bool gathers)
    : walk_count_(job.walk_count),
      sample_count_(job.gathers_on_host ? 1 : job.sample_count),
      row_count_(rows.row_count),
      width_px_(job.layout->size_px.width),
      reflects_(job.reflects()),
      gathers_(gathers),
      sums_light_(job.sumsLight()),
      has_middle_apart_(job.hasLens() && job.walk_count > 1) {
  const uint64_t width_px = width_px_;
  if (reflects_) {
    row_rays_ =
        width_px * job.walk_count * job.reflection->bounce_count * job.reflection->sample_count;
    if (walk_count_ > 1) step_count_ = job.reflection->bounce_count * job.reflection->sample_count;
  } else if (gathers_) {
    row_rays_ =
        std::max<uint64_t>(width_px * job.layout->lens->gathered_count / kGatheredPerWalked, 1);
  }
}

BandPart BandParts::take(uint64_t ray_count_max) {
  BandPart part = next(ray_count_max);
  part.kind = kind_;
  part.is_first = std::exchange(is_first_, false);
  part.ray_count = rayCount(part);
  const bool has_all_px = part.first_row == 0 && part.end_row == row_count_ && hasWholeRows(part);
  part.merges = kind_ == PartKind::kMerge || (part.walks() && hasWholeRows(part));
  const bool has_all_steps = part.end_step - part.first_step == step_count_;
  part.settles =
      has_all_px && has_all_steps && kind_ == (reflects_ ? PartKind::kReflect : PartKind::kWalk);
  goOnFrom(part);
  part.is_last = is_over_;
  return part;
}

BandPart BandParts::next(uint64_t ray_count_max) const {
  const bool begins_band = beginsRow() && row_ == 0;
  if (kind_ == PartKind::kWalk && begins_band && !reflects_ &&
      ray_count_max >= rowRays() * row_count_) {
    return takeSamples(ray_count_max);
  }
  const bool has_row = beginsRow() && ray_count_max >= rowRays();
  if (kind_ != PartKind::kMerge && (has_row || kind_ == PartKind::kSettle))
    return takeRows(ray_count_max);
  const uint64_t group_rays = rowRays() * abi::kTraceGroupSize / width_px_;
  if (step_ > 0 || (kind_ == PartKind::kReflect && step_count_ > 1 && ray_count_max < group_rays)) {
    return takeSteps(ray_count_max);
  }
  const bool has_walk = walk_count_ > 1 && column_ == 0 && ray_count_max >= width_px_;
  if (kind_ == PartKind::kWalk && has_walk) return takeWalks(ray_count_max);
  return takeColumns(ray_count_max);
}

bool BandParts::needsSettling() const {
  if (gathers_) return sample_ + 1 == metRound(sample_, sample_count_).end;
  return reflects_ || sums_light_;
}

uint64_t BandParts::rowRays() const {
  if (kind_ == PartKind::kSettle) return width_px_;
  if (kind_ == PartKind::kReflect || kind_ == PartKind::kGather) return row_rays_;
  return uint64_t{width_px_} * walk_count_;
}

uint64_t BandParts::rayCount(const BandPart& part) const {
  const uint64_t columns = part.end_column - part.first_column;
  const uint64_t px_count = columns * (part.end_row - part.first_row);
  if (!part.walks()) {
    return rowRays() * px_count / width_px_ * (part.end_step - part.first_step) / step_count_;
  }
  return px_count * (part.end_walk - part.first_walk) * (part.end_sample - part.first_sample);
}

bool BandParts::hasWholeRows(const BandPart& part) const {
  return part.end_column - part.first_column == width_px_ &&
         part.end_walk - part.first_walk == walk_count_;
}

BandPart BandParts::wholeRow() const {
  const bool has_rays = kind_ == PartKind::kWalk || kind_ == PartKind::kMerge;
  return {.first_sample = sample_,
          .end_sample = has_rays ? sample_ + 1 : sample_,
          .first_row = row_,
          .end_row = row_ + 1,
          .end_column = width_px_,
          .end_walk = walk_count_,
          .end_step = step_count_};
}

BandPart BandParts::takeSamples(uint64_t ray_count_max) const {
  const uint64_t count = ray_count_max / (rowRays() * row_count_);
  BandPart part = wholeRow();
  part.end_sample = uint32_t(std::min<uint64_t>(sample_ + count, sample_count_));
  part.end_row = row_count_;
  return part;
}

BandPart BandParts::takeRows(uint64_t ray_count_max) const {
  // Lists of a lens are of blocks.
  const uint64_t step = kind_ == PartKind::kSettle && gathers_ ? abi::kMetBlockSide_px : 1;
  const uint64_t count = std::max<uint64_t>(ray_count_max / rowRays() / step, 1) * step;
  BandPart part = wholeRow();
  part.end_row = uint32_t(std::min<uint64_t>(row_ + count, row_count_));
  return part;
}

// Some of the structures, in one row.
BandPart BandParts::takeWalks(uint64_t ray_count_max) const {
  BandPart part = wholeRow();
  if (has_middle_apart_ && sample_ == 0) {
    part.paths = is_past_middle_ ? RayPaths::kThroughLens : RayPaths::kMiddle;
  }
  part.first_walk = walk_;
  part.end_walk =
      uint32_t(std::min<uint64_t>(walk_ + ray_count_max / width_px_, uint64_t{walk_count_}));
  return part;
}

// In whole groups of one row, of one structure where rays are walked.
BandPart BandParts::takeColumns(uint64_t ray_count_max) const {
  const bool walks = kind_ == PartKind::kWalk;
  const uint64_t step_px = walks ? kWalkColumns_px : abi::kTraceGroupSize;
  const uint64_t step_rays = walks ? step_px : rowRays() * step_px / width_px_;
  const uint64_t steps =
      std::clamp<uint64_t>(ray_count_max / std::max<uint64_t>(step_rays, 1), 1, width_px_);
  BandPart part = walks || kind_ == PartKind::kMerge ? takeWalks(width_px_) : wholeRow();
  if (kind_ == PartKind::kMerge) {
    part.first_walk = 0;
    part.end_walk = walk_count_;
  }
  part.first_column = column_;
  part.end_column = uint32_t(std::min<uint64_t>(column_ + steps * step_px, width_px_));
  return part;
}

// Some of what one group of px mirrors.
BandPart BandParts::takeSteps(uint64_t ray_count_max) const {
  BandPart part = takeColumns(1);
  const uint64_t columns = part.end_column - part.first_column;
  const uint64_t steps = std::max<uint64_t>(ray_count_max / (columns * walk_count_), 1);
  part.first_step = step_;
  part.end_step = uint32_t(std::min<uint64_t>(step_ + steps, step_count_));
  return part;
}

void BandParts::goOnFrom(const BandPart& part) {
  step_ = part.end_step % step_count_;
  if (step_ > 0) return;
  column_ = part.end_column % width_px_;
  if (column_ > 0) return;
  if (part.walks() && walk_count_ > 1 && !part.merges) {
    walk_ = part.end_walk % walk_count_;
    if (walk_ == 0) kind_ = PartKind::kMerge;
    return;
  }
  if (kind_ == PartKind::kMerge) kind_ = PartKind::kWalk;
  is_past_middle_ = part.paths == RayPaths::kMiddle;
  if (is_past_middle_) return;
  row_ = part.end_row;
  if (row_ < row_count_) return;
  row_ = 0;
  goOnFromBand(part);
}

void BandParts::goOnFromBand(const BandPart& part) {
  if (kind_ == PartKind::kWalk && reflects_) {
    kind_ = PartKind::kReflect;
    return;
  }
  if (kind_ == PartKind::kGather) {
    is_over_ = true;
    return;
  }
  if (kind_ != PartKind::kSettle && !part.settles && needsSettling()) {
    kind_ = PartKind::kSettle;
    return;
  }
  kind_ = PartKind::kWalk;
  sample_ = std::max(part.end_sample, sample_ + 1);
  if (sample_ < sample_count_) return;
  is_over_ = !gathers_;
  if (!gathers_) return;
  kind_ = PartKind::kGather;
  sample_ = 0;
}

}  // namespace viewloom
