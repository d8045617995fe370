// SPDX-License-Identifier: Apache-2.0
// The source that would serve a display of a scene between two depths.
#pragma once

#include <optional>

#include "display/atlas_layout.h"

namespace viewloom {

struct AdvisedSource {
  Camera camera;  // px of size_px; in the world where the display has a pose there, else beside it
  SizePx size_px;
};

// As proto viewloom.v1.AdviseSourceResponse.
struct SourceAdvice {
  AdvisedSource source;
  uint32_t layer_count = 1;
  std::optional<AdvisedSource> second_source;
};

// A gap wider than this share of the image's width, between an edge at the near end and what lies
// behind it at the far one, shows things that hide more in turn: one layer more, one source more.
inline constexpr double kWideGapShare = 0.1;

// `spec` is completed. Depths are in front of the display's middle eye. Errors name the field as in
// proto AdviseSourceRequest.
absl::StatusOr<SourceAdvice> adviseSource(const DisplaySpec& spec, double near_m, double far_m);

}  // namespace viewloom
