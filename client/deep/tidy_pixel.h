// SPDX-License-Identifier: Apache-2.0
// Makes a deep pixel tidy: samples in any order, overlapping, become points nearest first.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "deep/deep_sample.h"

namespace viewloom::deep {

// By the rules of "Interpreting OpenEXR Deep Pixels": where samples overlap, each is split at the
// ends of the others, and parts that coincide are merged as if finely interleaved. What is left is
// composited with `over` to the pixel's flat colour. Then every part of a volume that reaches over
// more than a sixteenth of its 1/Z is cut, into at most eight slices that are points to all else;
// that changes no composite, as the parts of a split volume composite to the whole.
//
// Samples without a place in front of the camera (Z not a number, <= 0 or below a nanometre) are
// dropped and counted. Alpha is clamped to 0..1, colour to what binary16 can hold; what is not a
// number is 0. An opaque volume is a point at its front, as nothing behind that can be seen; so is
// one that reaches to infinity, whose density is 0 wherever one looks.
//
// Thread-safety: none; keeps its memory from pixel to pixel.
class PixelTidier {
 public:
  // Nearest first, without what neither covers nor shines. Valid until the next call.
  std::span<const DeepPoint> tidy(std::span<const DeepSample> samples);

  uint64_t droppedCount() const { return dropped_count_; }

 private:
  // Matter at one depth, or per metre of depth. Coinciding matter adds up in these numbers.
  struct Matter {
    double optical_depth = 0;    // -ln(1 - alpha) of what is not opaque
    glm::dvec3 emission{0};      // colour * optical_depth / alpha
    glm::dvec3 opaque_color{0};  // sum of the opaque
    double opaque_count = 0;
  };

  static bool isVolume(const DeepSample& sample);
  static Matter matterOf(const DeepSample& sample);
  static DeepPoint pointOf(const Matter& matter, double inv_z);
  void take(std::span<const DeepSample> samples);
  void addCoincident(size_t begin, size_t end);
  void addVolume(double begin_m, double end_m, const Matter& per_metre);
  void addPoint(const DeepPoint& point);
  void sweep();

  std::vector<DeepSample> samples_;  // those with a place, by z_m, points before volumes
  std::vector<DeepSample> by_back_;  // the volumes, by z_back_m
  std::vector<DeepPoint> points_;
  uint64_t dropped_count_ = 0;
};

}  // namespace viewloom::deep
