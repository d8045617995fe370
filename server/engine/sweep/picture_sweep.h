// SPDX-License-Identifier: Apache-2.0
// Plan of a picture that is swept, and what its pixels cost.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>

#include "base/cost_estimate.h"
#include "engine/engine.h"
#include "sweep/sweep_plan.h"
#include "sweep/swept_frame.h"

namespace viewloom {

// Immutable; costs may be noted from any thread.
struct PictureSweep final : Plan {
  PictureSweep(SweepPlan swept_plan, double source_inv_z_max, uint64_t area_px,
               std::shared_ptr<CostEstimate> cost_of_all)
      : plan(std::move(swept_plan)),
        inv_z_max(source_inv_z_max),
        row_px(std::max<uint64_t>(area_px / plan.rowCount(), 1)),
        of_all(std::move(cost_of_all)),
        px_cost(std::make_shared<CostEstimate>(*of_all)) {}

  bool holdsFor(const PreparedFrame& frame) const override {
    return sourceOf(frame).measured().stats.inv_z_max == inv_z_max;
  }

  const SweepPlan plan;
  void note(uint64_t px_count, int64_t measured_ns) const {
    px_cost->note(px_count, measured_ns);
    of_all->note(px_count, measured_ns);
  }

  const double inv_z_max;                       // of the source, 1/m
  const uint64_t row_px;                        // of the atlas, that a row of the plan fills
  const std::shared_ptr<CostEstimate> of_all;   // of a px of all pictures
  const std::shared_ptr<CostEstimate> px_cost;  // of this picture
};

inline const PictureSweep& sweepOf(const AtlasOrder& order) {
  return static_cast<const PictureSweep&>(*order.plan);
}

}  // namespace viewloom
