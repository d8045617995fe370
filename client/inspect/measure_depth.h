// SPDX-License-Identifier: Apache-2.0
// Measurements in the depth of a layer: its range, its step and its noise.
#pragma once

#include "inspect/depth_samples.h"

namespace viewloom::inspect {

// Step and noise are those of SourceStats (ingest_service.proto), by the definition that
// shaders/structure/measure_depth.comp has, but without its bins, so up to a sixteenth below: of
// one px in each block of 4x4, second differences along x and y in turn.
struct DepthMeasures {
  // Range of surfaces nearer than infinity, in 1/m; 0 without any.
  float inv_z_min = 0;
  float inv_z_median = 0;
  float inv_z_max = 0;
  float inv_z_far = 0;   // 2nd percentile
  float inv_z_near = 0;  // 98th percentile
  // The 1st percentile of differences that are not 0, 1/m; for stepped depth, its step.
  float step = 0;
  // Their median as standard deviation of independent noise, 1/m.
  float noise_sigma = 0;
  // How far neighbours are from one surface, where they are not equal: the median, 1/m.
  float difference_median = 0;
  uint64_t changing_count = 0;  // places where depth is not the same in all three px
  uint64_t bent_count = 0;      // those whose second difference is not 0
};

DepthMeasures measureDepth(const DepthSamples& samples);

// The median 1/Z of the surfaces in a part of the image, infinitely far ones included; kNoSurface
// without any. Shares of the sides, from the top left.
struct ImageArea {
  double left = 0, top = 0, right = 1, bottom = 1;
};
float medianIn(const DepthSamples& samples, const ImageArea& area);

}  // namespace viewloom::inspect
