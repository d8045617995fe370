// SPDX-License-Identifier: Apache-2.0
// How the rays of a band are cut into parts of bounded work, between which a device may do
// something else.
#pragma once

#include <cstdint>

#include "picture/trace_job.h"

namespace viewloom {

// A part has no more rays than this, unless those of the least that there can be are more: of a
// walk a row, else as many columns of one as a group has invocations.
inline constexpr uint64_t kPartRays = uint64_t{1} << 21;
// Rays of the second stage of a lens that are counted as one that is walked: fewer than it takes.
inline constexpr uint64_t kGatheredPerWalked = 4;

// Kinds of parts: rays of samples are walked; what the px of a sample mirror is found; the second
// stage of a lens.
enum class PartKind : uint8_t { kWalk, kReflect, kGather };

// Rows [first_row, end_row) of a band. Samples [first_sample, end_sample) are walked; where several
// are, in all rows. Of the other kinds, first_sample is the one whose px mirror, and a part of one
// row may have only px [first_column, end_column) of it, which begin with a group of invocations.
struct BandPart {
  PartKind kind = PartKind::kWalk;
  uint32_t first_sample = 0;
  uint32_t end_sample = 0;
  uint32_t first_row = 0;
  uint32_t end_row = 0;
  uint32_t first_column = 0;
  uint32_t end_column = 0;
  // Gathered ones as so many walked, reflected ones as if all px were rough.
  uint64_t ray_count = 0;
  bool is_first = false;  // of the band
  bool is_last = false;
  bool ends_band = false;  // whether its px are the last of the band

  bool walks() const { return kind == PartKind::kWalk; }
};

// Walked samples come first. Where things are mirrored, each sample is followed by what it mirrors.
// Thread-safety: none.
class BandParts {
 public:
  BandParts(const TraceJob& job, BandRows rows);

  bool isOver() const { return is_over_; }
  // Kind of the next part.
  PartKind kind() const { return kind_; }
  // The next part, with no more rays than this, unless those of the least part are more, or of a
  // sample of which some px have no rays any more: those are listed for the whole band.
  BandPart take(uint64_t ray_count_max = kPartRays);

 private:
  BandPart takeSamples(uint64_t ray_count_max);
  BandPart takeRows(uint64_t ray_count_max);
  BandPart takeColumns(uint64_t ray_count_max);
  bool isWhole(uint32_t sample) const;
  uint64_t rowRays() const;
  void goOnFrom(const BandPart& part);

  uint64_t walked_row_rays_ = 0;  // of a sample
  uint64_t row_rays_ = 0;         // of the other kinds
  uint32_t sample_count_ = 0;
  uint32_t row_count_ = 0;
  uint32_t width_px_ = 0;
  bool reflects_ = false;
  bool gathers_ = false;
  PartKind kind_ = PartKind::kWalk;
  uint32_t sample_ = 0;  // where the next part begins
  uint32_t row_ = 0;
  uint32_t column_ = 0;
  bool is_first_ = true;
  bool is_over_ = false;
};

}  // namespace viewloom
