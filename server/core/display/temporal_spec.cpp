// SPDX-License-Identifier: Apache-2.0
#include "display/temporal_spec.h"

#include "display/field_checks.h"

namespace viewloom {

absl::Status complete(TemporalSpec& temporal) {
  VIEWLOOM_RETURN_IF_ERROR(checkRange(temporal.output_rate_hz, kOutputRateMin_hz, kOutputRateMax_hz,
                                      "effects.temporal.output_rate_hz"));
  VIEWLOOM_RETURN_IF_ERROR(
      checkRange(temporal.bridge_s, 0, kBridgeMax_s, "effects.temporal.bridge_s"));
  if (temporal.bridge_s == 0) temporal.bridge_s = kDefaultBridge_s;
  return absl::OkStatus();
}

}  // namespace viewloom
