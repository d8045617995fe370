// SPDX-License-Identifier: Apache-2.0
// Measurements of a frame: stage times, endings of rays, depth of a source.
#pragma once

#include <cstdint>

namespace viewloom {

// Numbers of rays of an atlas, by their ending.
struct Coverage {
  uint64_t hit = 0;
  uint64_t hit_assumed = 0;
  uint64_t hidden = 0;
  uint64_t outside = 0;
  uint64_t empty = 0;

  uint64_t rayCount() const { return hit + hit_assumed + hidden + outside + empty; }
  void add(const Coverage& other) {
    hit += other.hit;
    hit_assumed += other.hit_assumed;
    hidden += other.hidden;
    outside += other.outside;
    empty += other.empty;
  }
  bool operator==(const Coverage&) const = default;
};

// Numbers of reflected rays of an atlas, by their ending (proto ReflectionShares).
struct ReflectionCounts {
  uint64_t hit = 0;
  uint64_t assumed = 0;
  uint64_t back = 0;
  uint64_t cube = 0;
  uint64_t environment = 0;
  uint64_t bent = 0;  // among all, those that would have gone below their own surface

  uint64_t rayCount() const { return hit + assumed + back + cube + environment; }
  void add(const ReflectionCounts& other) {
    hit += other.hit;
    assumed += other.assumed;
    back += other.back;
    cube += other.cube;
    environment += other.environment;
    bent += other.bent;
  }
  bool operator==(const ReflectionCounts&) const = default;
};

// Times of the stages in nanoseconds (proto viewloom.v1.StageTimes).
struct StageTimes {
  int64_t receive_ns = 0;
  int64_t decode_ns = 0;
  int64_t upload_ns = 0;
  int64_t build_ns = 0;
  int64_t retime_ns = 0;  // before the build
  int64_t wait_ns = 0;
  int64_t trace_ns = 0;
  int64_t encode_ns = 0;
  int64_t total_ns = 0;
};

// Measured while a structure is built; 1/m unless a name says otherwise.
struct SourceStats {
  double depth_step = 0;
  double noise_sigma = 0;
  double connection_tolerance = 0;
  uint64_t bad_samples_count = 0;
  uint64_t unsorted_columns_count = 0;
  uint64_t bad_normals_count = 0;
  uint64_t bad_motions_count = 0;
  double inv_z_min = 0;
  double inv_z_max = 0;
  double inv_z_near = 0;       // 98th percentile of 1/Z
  double inv_z_far = 0;        // 2nd percentile of 1/Z
  double smoothing_reach = 0;  // most that coarse samples were moved; 0: they are fine
};

}  // namespace viewloom
