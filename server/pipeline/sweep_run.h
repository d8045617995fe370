// SPDX-License-Identifier: Apache-2.0
// One atlas that is swept: in pieces of rows, and packed in strips once all are swept.
#pragma once

#include <cstdint>
#include <memory>

#include "pipeline/atlas_run.h"
#include "sweep/view_sweeper.h"

namespace viewloom {

// Thread-safety: sweepPiece() from any thread; the counters are EncodeQueue's.
class SweepRun {
 public:
  // The atlas is filled; holding it keeps it from reuse.
  SweepRun(AtlasRunPtr run, SweepPlan plan, std::shared_ptr<SweptAtlas> atlas);

  uint32_t pieceCount() const { return piece_count_; }
  // A piece to sweep or a strip to pack; while the last pieces are swept there is none.
  bool hasPart() const { return next_piece < piece_count_ || swept_count == piece_count_; }
  const AtlasRunPtr& run() const { return run_; }

  // Each piece once.
  Coverage sweepPiece(uint32_t piece, ViewSweeper& sweeper);
  const SweptAtlas& atlas() const { return *atlas_; }

  uint32_t next_piece = 0;
  uint32_t swept_count = 0;
  uint32_t next_strip = 0;

 private:
  const AtlasRunPtr run_;
  const SweepPlan plan_;
  const std::shared_ptr<SweptAtlas> atlas_;
  const uint32_t piece_count_;
};

using SweepRunPtr = std::shared_ptr<SweepRun>;

}  // namespace viewloom
