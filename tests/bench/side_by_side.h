// SPDX-License-Identifier: Apache-2.0
// Runs contestants on one load, turn by turn, so that a busy host slows all of them alike.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/contestant.h"

namespace viewloom::bench {

enum class Work : uint8_t { kBuild, kBuildAndTrace };

// Medians of the rounds.
struct Measured {
  double build_ms = 0;
  double trace_ms = 0;  // kBuildAndTrace; as what follows
  double total_ms = 0;  // of a build and the trace after it
  // Share of rays that differ from the reference: both hit, and their 1/Z is more than half a px of
  // disparity of the outermost view apart; or one hits and the other does not. None without one.
  std::optional<double> differ_share;
  // PSNR of some of the views, against the true ones (true_views.h). None without either.
  std::optional<double> psnr_db;
};

struct LoadReport {
  std::string load;
  uint64_t ray_count = 0;
  double disparity_span_px = 0;
  std::map<std::string, Measured> by_contestant;
};

// Those that do not take the load are left out. `reference`: the name of the contestant that the
// others' hits are compared with.
LoadReport runSideBySide(const BenchLoad& load,
                         const std::vector<std::unique_ptr<Contestant>>& contestants, Work work,
                         int round_count, std::string_view reference);

}  // namespace viewloom::bench
