// SPDX-License-Identifier: Apache-2.0
// Output of the benchmark.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/trace_method.h"
#include "bench/memory_use.h"
#include "bench/side_by_side.h"
#include "bench/visit_counter.h"

namespace viewloom::bench {

// Measurements that only viewloom has of itself. Its walk is a contestant of that name where it
// sweeps.
struct OwnReport {
  TraceMethod method = TraceMethod::kWalk;
  Visits visits;  // of its walk
  MemoryUse walk;
  std::optional<MemoryUse> sweep;
};

// {"name", "rays", "disparity_span_px", "method", "build_ms", "ns_per_ray", "total_ms",
// "differ_share", "psnr_db", "visits", "memory_mib"}, by contestant where there are several. A
// build has no rays.
nlohmann::ordered_json buildJson(const LoadReport& report);
nlohmann::ordered_json traceJson(const LoadReport& report, const OwnReport& own);

// The same for people: a line a contestant.
std::string asTable(const nlohmann::ordered_json& load);

// "2000-01-01", UTC.
std::string today();

}  // namespace viewloom::bench
