// SPDX-License-Identifier: Apache-2.0
// How the rays of a band are cut into parts of bounded work, between which a device may do
// something else.
#pragma once

#include <cstdint>

#include "picture/trace_job.h"

namespace viewloom {

// A part walks no more rays than this, unless a single ray of each px are more, or those that one
// row reflects.
inline constexpr uint64_t kPartRays = uint64_t{1} << 21;
// Rays of the second stage of a lens that are counted as one that is walked: fewer than it takes.
inline constexpr uint64_t kGatheredPerWalked = 4;

// Samples [first, end) are walked, or, if there are none, something is done with rows [first_row,
// end_row) of the band: what the px of that sample mirror is found, or the second stage of a lens.
struct BandPart {
  uint32_t first_sample = 0;
  uint32_t end_sample = 0;
  uint32_t first_row = 0;
  uint32_t end_row = 0;
  bool reflects = false;
  // Gathered ones as so many walked, reflected ones as if all px were rough.
  uint64_t ray_count = 0;

  bool walks() const { return first_sample < end_sample; }
};

// Walked samples come first. Where things are mirrored, each sample is followed by what it mirrors.
class BandParts {
 public:
  BandParts(const TraceJob& job, BandRows rows);

  uint32_t count() const { return walk_count_ * (1 + reflect_count_) + gather_count_; }
  BandPart at(uint32_t index) const;

 private:
  uint32_t rowPartCount();

  uint64_t sample_rays_ = 0;  // of all px
  uint64_t row_rays_ = 0;     // of a row's parts
  uint32_t sample_count_ = 0;
  uint32_t row_count_ = 0;
  uint32_t samples_per_part_ = 1;
  uint32_t rows_per_part_ = 1;
  uint32_t walk_count_ = 0;
  uint32_t gather_count_ = 0;
  uint32_t reflect_count_ = 0;  // of each sample
};

}  // namespace viewloom
