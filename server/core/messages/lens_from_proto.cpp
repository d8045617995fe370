// SPDX-License-Identifier: Apache-2.0
#include "messages/lens_from_proto.h"

#include "messages/enum_from_proto.h"

namespace viewloom {
namespace {

constexpr EnumRow<v1::Quality, Quality> kQualities[] = {
    {v1::QUALITY_UNSPECIFIED, Quality::kBalanced},
    {v1::QUALITY_DRAFT, Quality::kDraft},
    {v1::QUALITY_BALANCED, Quality::kBalanced},
    {v1::QUALITY_BEST, Quality::kBest}};

// Whether rays that something may stand in the way of are walked.
constexpr EnumRow<v1::GatherMode, bool> kGatherModes[] = {{v1::GATHER_MODE_UNSPECIFIED, false},
                                                          {v1::GATHER_MODE_FAST, false},
                                                          {v1::GATHER_MODE_EXACT, true}};

}  // namespace

absl::StatusOr<LensSpec> lensFromProto(const v1::LensEffect& proto) {
  const auto is_exact = enumFromProto(proto.mode(), "effects.lens.mode", kGatherModes);
  VIEWLOOM_RETURN_IF_ERROR(is_exact.status());
  LensSpec lens{.aperture_radius_m = proto.aperture_radius_m(),
                .has_automatic_aperture = proto.automatic_aperture(),
                .focus_distance_m = std::nullopt,
                .blades = proto.blades(),
                .rotation_rad = proto.rotation_rad(),
                .walked_count = proto.samples(),
                .gathered_count = std::nullopt,
                .is_exact = *is_exact};
  if (proto.has_focus_distance_m()) lens.focus_distance_m = proto.focus_distance_m();
  if (proto.has_gathered_samples()) lens.gathered_count = proto.gathered_samples();
  return lens;
}

absl::StatusOr<Quality> qualityFromProto(v1::Quality proto) {
  return enumFromProto(proto, "quality", kQualities);
}

}  // namespace viewloom
