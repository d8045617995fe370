// SPDX-License-Identifier: Apache-2.0
#include "schedule/build_gate.h"

#include <algorithm>

namespace viewloom {

std::optional<int64_t> BuildGate::waitUntilNs(const StreamDemand& demand, int64_t now_ns) const {
  if (!built_ns_ || demand.takes_all) return std::nullopt;
  const int64_t until_ns = demand.is_watched ? *built_ns_ + kHeldFrame_ns : unwatched_ns_;
  if (until_ns <= now_ns) return std::nullopt;
  return until_ns;
}

// Each frame without viewers uses up a part of the burst, which comes back with time.
void BuildGate::noteBuilt(const StreamDemand& demand, int64_t now_ns) {
  built_ns_ = now_ns;
  if (demand.is_watched) return;
  const int64_t begin_ns = now_ns - (kUnwatchedBurst - 1) * kUnwatched_ns;
  unwatched_ns_ = std::max(unwatched_ns_, begin_ns) + kUnwatched_ns;
}

}  // namespace viewloom
