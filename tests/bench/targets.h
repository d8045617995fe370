// SPDX-License-Identifier: Apache-2.0
// Aims of viewloom beside its rivals and itself: how far off each one is.
#pragma once

#include <nlohmann/json.hpp>

namespace viewloom::bench {

// Ratios of loads in the form of buildJson() and traceJson() (report.h); unmeasured ones are left
// out: [{"what", "load", "value", "target", "is_met"}]. A target is ">= " or "<= " a number. Times
// are ratios of medians; "trace" is ns_per_ray.
nlohmann::ordered_json targetRatios(const nlohmann::ordered_json& loads);

}  // namespace viewloom::bench
