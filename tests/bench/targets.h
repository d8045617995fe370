// SPDX-License-Identifier: Apache-2.0
// What viewloom aims at, beside its rivals and itself: how far off each aim is.
#pragma once

#include <nlohmann/json.hpp>

namespace viewloom::bench {

// Of loads as buildJson() and traceJson() make them (report.h); those that were not measured are
// left out: [{"what", "load", "value", "target", "is_met"}]. A target is ">= " or "<= " a number.
// Times are ratios of medians; "trace" is ns_per_ray.
nlohmann::ordered_json targetRatios(const nlohmann::ordered_json& loads);

}  // namespace viewloom::bench
