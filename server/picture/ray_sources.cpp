// SPDX-License-Identifier: Apache-2.0
#include "picture/ray_sources.h"

#include "calibration/make_lenticular.h"

namespace viewloom {

uint32_t raySourceOf(const AtlasLayout& layout) {
  if (std::holds_alternative<MicrolensRays>(layout.rays)) return abi::kRaysOfMicrolenses;
  if (std::holds_alternative<LenticularRays>(layout.rays)) return abi::kRaysOfLenticular;
  return abi::kRaysOfPinholes;
}

abi::Microlenses microlensesOf(const AtlasLayout& layout) {
  const auto* rays = std::get_if<MicrolensRays>(&layout.rays);
  if (rays == nullptr) return {};
  const double slope = 1 / layout.views.front().camera.intrinsics.focal_px.x;
  return {.first_px = abi::vec2(rays->first_px),
          .pitch_px = float(rays->lens_pitch_px),
          .slope_per_px = float(rays->is_flipped ? -slope : slope),
          .count = {rays->columns, rays->rows},
          .middle_px = abi::vec2(rays->middle_px),
          .m_per_px = float(rays->m_per_px),
          .distance_m = float(rays->distance_m)};
}

abi::LenticularEyes lenticularEyesOf(const AtlasLayout& layout, uint32_t sample) {
  const auto* rays = std::get_if<LenticularRays>(&layout.rays);
  if (rays == nullptr) return {};
  const uint8_t channels = layout.samples[sample].channels;
  return {.lens = makeLenticular(rays->calibration),
          .channel = channels == kRedChannel     ? 0u
                     : channels == kGreenChannel ? 1u
                                                 : 2u,
          .view_count = rays->view_count,
          .view_cone_rad = float(rays->view_cone_rad),
          .distance_m = float(rays->distance_m)};
}

}  // namespace viewloom
