// SPDX-License-Identifier: Apache-2.0
#include "messages/temporal_from_proto.h"

#include "messages/enum_from_proto.h"

namespace viewloom {
namespace {

constexpr EnumRow<v1::TemporalMode, TemporalMode> kModes[] = {
    {v1::TEMPORAL_MODE_UNSPECIFIED, TemporalMode::kPredict},
    {v1::TEMPORAL_MODE_PREDICT, TemporalMode::kPredict},
    {v1::TEMPORAL_MODE_INTERPOLATE, TemporalMode::kInterpolate}};

}  // namespace

absl::StatusOr<TemporalSpec> temporalFromProto(const v1::TemporalEffect& proto) {
  const auto mode = enumFromProto(proto.mode(), "mode", kModes);
  VIEWLOOM_RETURN_IF_ERROR(mode.status());
  return TemporalSpec{
      .output_rate_hz = proto.output_rate_hz(), .mode = *mode, .bridge_s = proto.bridge_s()};
}

}  // namespace viewloom
