// SPDX-License-Identifier: Apache-2.0
// Strips of an atlas that an engine has handed on to the worker threads.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "pipeline/atlas_run.h"

namespace viewloom {

// Holding it keeps what it is made of from reuse. Thread-safety: the counters are EncodeQueue's.
struct StripBatch {
  StripBatch(AtlasRunPtr run_of_strips, StripWorkPtr handed_on)
      : run(std::move(run_of_strips)), work(std::move(handed_on)) {}

  // A piece to make or a strip to pack; while the last pieces are made there is none.
  bool hasPart() const {
    return next_piece < work->shape.piece_count || made_count == work->shape.piece_count;
  }

  const AtlasRunPtr run;
  const StripWorkPtr work;
  uint32_t next_piece = 0;
  uint32_t made_count = 0;
  uint32_t next_strip = 0;  // counts from the first of the work
};

using StripBatchPtr = std::shared_ptr<StripBatch>;

}  // namespace viewloom
