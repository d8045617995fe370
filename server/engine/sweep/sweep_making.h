// SPDX-License-Identifier: Apache-2.0
// One atlas that is swept: its works for the worker threads.
#pragma once

#include <memory>
#include <vector>

#include "sweep/atlas_pool.h"
#include "sweep/sweep_engine.h"

namespace viewloom {

// Hands everything on in its only step. Thread-safety: as of Making.
class SweepMaking final : public Making {
 public:
  // `planes`: in forms that the plan can colour. Takes the atlas over until all works are gone.
  SweepMaking(const AtlasOrder& order, const TraceOutputs& planes, std::shared_ptr<HeldAtlas> atlas,
              const std::shared_ptr<SweeperShelf>& sweepers, HandOn hand_on);

  const TraceOutputs& planes() const override { return planes_; }
  bool holdsRoom() const override { return !works_.empty(); }
  MakingStep step() override;
  void giveUp() override {}

 private:
  TraceOutputs planes_;
  const HandOn hand_on_;
  std::vector<StripWorkPtr> works_;  // until they are handed on
};

}  // namespace viewloom
