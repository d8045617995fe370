// SPDX-License-Identifier: Apache-2.0
// What the benchmark prints.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/trace_method.h"
#include "bench/side_by_side.h"
#include "bench/viewloom_contestant.h"

namespace viewloom::bench {

// `method`: viewloom's; `visits`: of its walk, which a contestant of that name is where it sweeps.
// {"name", "rays", "disparity_span_px", "method", "build_ms", "ns_per_ray", "total_ms",
// "differ_share", "visits"}, by contestant where there are several. A build has no rays.
nlohmann::ordered_json buildJson(const LoadReport& report);
nlohmann::ordered_json traceJson(const LoadReport& report, TraceMethod method,
                                 const Visits& visits);

// The same for people: a line a contestant.
std::string asTable(const nlohmann::ordered_json& load);

}  // namespace viewloom::bench
