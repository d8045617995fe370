// SPDX-License-Identifier: Apache-2.0
// How the rays of a band are cut into parts of bounded work, between which a device may do
// something else.
#pragma once

#include <cstdint>

#include "picture/trace_job.h"

namespace viewloom {

// A part has no more rays than this, unless those of the least that there can be are more: of a
// walk kWalkColumns_px px in one structure, of what is settled a row, or one of blocks of a lens,
// else as many columns of a row as a group has invocations. In several structures those mirror
// bounce by bounce.
inline constexpr uint64_t kPartRays = uint64_t{1} << 21;
// Rays of the second stage of a lens that are counted as one that is walked: fewer than it takes.
inline constexpr uint64_t kGatheredPerWalked = 4;
// Columns of px that begin a part of a walked row: those of the longest runs that a group takes.
inline constexpr uint32_t kWalkColumns_px = 64 * 60;

// Kinds of parts: rays of samples are walked; answers of several structures become px; what the px
// of a sample mirror is found; once a sample is known in the whole band, its light or what it met
// is added to that of the others; the second stage of a lens.
enum class PartKind : uint8_t { kWalk, kMerge, kReflect, kSettle, kGather };

// Kinds of rays of a sample.
enum class RayPaths : uint8_t { kAll, kMiddle, kThroughLens };

// Rows [first_row, end_row) of a band. Samples [first_sample, end_sample) are walked; where several
// are, in all rows. Parts of the other kinds are of first_sample. Where listed blocks are walked,
// its share of the band is one of the list.
//
// A part of one row may have only px [first_column, end_column) of it, which begin with a group of
// invocations. If the row is walked in several structures, it may have only those
// [first_walk, end_walk), and parts that merge the row follow. What px mirror in several structures
// is found in as many steps as it has samples and bounces; a part may have only some of them.
struct BandPart {
  PartKind kind = PartKind::kWalk;
  uint32_t first_sample = 0;
  uint32_t end_sample = 0;
  uint32_t first_row = 0;
  uint32_t end_row = 0;
  uint32_t first_column = 0;
  uint32_t end_column = 0;
  uint32_t first_walk = 0;
  uint32_t end_walk = 0;
  uint32_t first_step = 0;
  uint32_t end_step = 0;
  RayPaths paths = RayPaths::kAll;
  // Gathered ones as so many walked, reflected ones as if all px were rough. Of merged answers one
  // each, of settled px one each.
  uint64_t ray_count = 0;
  bool is_first = false;  // of the band
  bool is_last = false;
  bool merges = false;   // makes px of what structures answer
  bool settles = false;  // has all px of its samples, and settles them

  bool walks() const { return kind == PartKind::kWalk; }
};

// Walked samples come first. Where things are mirrored, each sample is followed by what it mirrors.
// Thread-safety: none.
class BandParts {
 public:
  // `gathers`: the device gathers a lens, for which the job may gather (gathersOnDevice).
  BandParts(const TraceJob& job, BandRows rows, bool gathers);
  // The same of a device that gathers whatever it may.
  BandParts(const TraceJob& job, BandRows rows) : BandParts(job, rows, job.mayGather()) {}

  bool isOver() const { return is_over_; }
  // Kind of the next part.
  PartKind kind() const { return kind_; }
  // The next part, with no more rays than this, unless those of the least part are more.
  BandPart take(uint64_t ray_count_max = kPartRays);

 private:
  BandPart next(uint64_t ray_count_max) const;
  BandPart takeSamples(uint64_t ray_count_max) const;
  BandPart takeRows(uint64_t ray_count_max) const;
  BandPart takeWalks(uint64_t ray_count_max) const;
  BandPart takeColumns(uint64_t ray_count_max) const;
  BandPart takeSteps(uint64_t ray_count_max) const;
  BandPart wholeRow() const;
  bool beginsRow() const { return column_ == 0 && walk_ == 0 && step_ == 0 && !is_past_middle_; }
  bool needsSettling() const;
  uint64_t rowRays() const;
  uint64_t rayCount(const BandPart& part) const;
  bool hasWholeRows(const BandPart& part) const;
  void goOnFrom(const BandPart& part);
  void goOnFromBand(const BandPart& part);

  uint64_t row_rays_ = 1;  // of reflected or gathered ones
  uint32_t walk_count_ = 1;
  uint32_t step_count_ = 1;  // of what mirrors in several structures
  uint32_t sample_count_ = 0;
  uint32_t row_count_ = 0;
  uint32_t width_px_ = 0;
  bool reflects_ = false;
  bool gathers_ = false;
  bool sums_light_ = false;
  bool has_middle_apart_ = false;  // of several walks: rays that may be merged one after the other
  PartKind kind_ = PartKind::kWalk;
  uint32_t sample_ = 0;  // where the next part begins
  uint32_t row_ = 0;
  uint32_t walk_ = 0;
  uint32_t column_ = 0;
  uint32_t step_ = 0;
  bool is_past_middle_ = false;
  bool is_first_ = true;
  bool is_over_ = false;
};

}  // namespace viewloom
