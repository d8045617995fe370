// SPDX-License-Identifier: Apache-2.0
#include "messages/depth_format_from_proto.h"

#include <optional>

#include "messages/enum_from_proto.h"

namespace viewloom {
namespace {

constexpr EnumRow<v1::DepthMeaning, DepthMeaning> kMeanings[] = {
    {v1::DEPTH_MEANING_PLANAR, DepthMeaning::kPlanar},
    {v1::DEPTH_MEANING_RAY_DISTANCE, DepthMeaning::kRayDistance},
    {v1::DEPTH_MEANING_WINDOW, DepthMeaning::kWindow},
    {v1::DEPTH_MEANING_DISPARITY, DepthMeaning::kDisparity}};

}  // namespace

absl::StatusOr<DepthFormat> depthFormatFromProto(const v1::DepthFormat& proto) {
  const auto meaning = enumFromProto(proto.meaning(), "meaning", kMeanings);
  VIEWLOOM_RETURN_IF_ERROR(meaning.status());
  DepthFormat depth{.meaning = *meaning,
                    .scale = proto.scale() == 0 ? 1 : proto.scale(),
                    .offset = proto.offset(),
                    .min_depth = proto.min_depth(),
                    .max_depth = proto.max_depth() == 0 ? 1 : proto.max_depth(),
                    .near_z_m = proto.near_z_m(),
                    .far_z_m = proto.far_z_m(),
                    .invalid_value = std::nullopt,
                    .invalid_is_far = proto.invalid_is_far()};
  if (proto.has_invalid_value()) depth.invalid_value = proto.invalid_value();
  return depth;
}

}  // namespace viewloom
