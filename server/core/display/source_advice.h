// SPDX-License-Identifier: Apache-2.0
// Recommends a source for a display of a scene between two depths.
#pragma once

#include <optional>

#include "display/atlas_layout.h"

namespace viewloom {

struct AdvisedSource {
  Camera camera;  // in pixels of size_px; in the world, or relative to a display without world_pose
  SizePx size_px;
};

// See proto viewloom.v1.AdviseSourceResponse.
struct SourceAdvice {
  AdvisedSource source;
  uint32_t layer_count = 1;
  std::optional<AdvisedSource> second_source;
};

// Share of the image's width from which on a gap is wide. The gap lies between an edge at the near
// end and the surface behind it at the far end. Things in a wide gap hide other things in turn, so
// the advice is one more layer and one more source.
inline constexpr double kWideGapShare = 0.1;

// Advice for a completed spec. Depths are in front of the display's middle eye. Errors name the
// field as in proto AdviseSourceRequest.
absl::StatusOr<SourceAdvice> adviseSource(const DisplaySpec& spec, double near_m, double far_m);

}  // namespace viewloom
