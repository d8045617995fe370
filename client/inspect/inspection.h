// SPDX-License-Identifier: Apache-2.0
// A frame looked at: what its planes are, what was measured in them, and what looks wrong.
#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include "files/frame_manifest.h"
#include "inspect/suspicions.h"

namespace viewloom::inspect {

struct LayerInspection {
  v1::Plane color;
  v1::Plane depth;
  DepthSamples samples;
  DepthMeasures measures;
  std::vector<Suspicion> suspicions;
};

struct SourceInspection {
  v1::Camera camera;
  std::vector<LayerInspection> layers;
};

// Errors name the field of the frame. Suspicions come without remedies (inspect/remedies.h).
// CANCELLED soon after a stop is requested.
absl::StatusOr<std::vector<SourceInspection>> inspectFrame(const files::LoadedFrame& frame,
                                                           const std::stop_token& stop = {});

// The colour of a layer beside its depth: white near, black far (98th and 2nd percentile of 1/Z,
// and infinity), magenta where there is no surface.
struct InspectionPicture {
  uint32_t width_px = 0;
  uint32_t height_px = 0;
  std::vector<uint8_t> rgb;  // [height_px][width_px][3], packed, top row first
};

// `color_bytes` of the layer's colour plane. At most 1024 px a side of each half: larger layers are
// thinned out.
absl::StatusOr<InspectionPicture> drawInspection(const LayerInspection& layer,
                                                 const std::vector<uint8_t>& color_bytes);

}  // namespace viewloom::inspect
