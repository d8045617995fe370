// SPDX-License-Identifier: Apache-2.0
// Work that waits for encode threads: pieces of atlases to make, and strips to pack.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "pipeline/atlas_run.h"
#include "pipeline/pack_costs.h"
#include "schedule/fair_shares.h"

namespace viewloom {

// Strips of an atlas that an engine has handed on to the worker threads. Holding it keeps what it
// is made of from reuse. Thread-safety: the counters are EncodeQueue's.
struct StripBatch {
  StripBatch(AtlasRunPtr run_of_strips, StripWorkPtr handed_on)
      : run(std::move(run_of_strips)), work(std::move(handed_on)) {}

  // A piece to make or a plane to pack; while the last pieces are made there is none.
  bool hasPart() const {
    if (work->shape.begins_with_one && next_piece == 1 && made_count == 0) return false;
    return next_piece < work->shape.piece_count || made_count == work->shape.piece_count;
  }

  const AtlasRunPtr run;
  const StripWorkPtr work;
  uint32_t next_piece = 0;
  uint32_t made_count = 0;
  uint32_t next_strip = 0;       // counts from the first of the work
  size_t next_pack = 0;          // of that strip: place in AtlasRun::packs
  uint32_t next_row = 0;         // of that plane, from the strip's first
  uint32_t slice_row_count = 0;  // of that plane: rows that are packed at once
};

using StripBatchPtr = std::shared_ptr<StripBatch>;

// A part of a batch: a piece of its work, or, once all are made, a plane of a strip to pack. Where
// that takes long, it is a slice of the plane: whole bands, or a share of one.
struct EncodeTask {
  StripBatchPtr batch;
  bool is_strip = false;
  uint32_t index = 0;            // of the piece, or the strip; counts from the first of the batch
  size_t pack = 0;               // of the strip: place in AtlasRun::packs
  BandRows rows = {};            // of the strip, from its first, that are packed
  uint32_t slice_row_count = 0;  // of each slice of that plane but the last
  int64_t predicted_ns = 0;
};

// Atlases go in fair shares, part by part. What was given up is dropped between two parts.
// Thread-safety: all methods may be called from any thread.
class EncodeQueue {
 public:
  // The shares outlive it.
  explicit EncodeQueue(FairShares& shares) : shares_(shares) {}

  // Dropped once the queue is closed.
  void push(StripBatchPtr batch);
  // Work that others wait for goes before all that is inside of the same claim. Also once the queue
  // is closed, from a thread that will pop again.
  void pushFirst(StripBatchPtr batch);
  PackCosts& packCosts() { return pack_costs_; }
  // Whether something waits for a thread that is for somebody who has had less so far than whoever
  // pays for the claim.
  bool hasForOthersWithLess(const Claim& claim);
  // Waits for something to do. Empty once the queue is closed and everything in it is done.
  std::optional<EncodeTask> pop();
  // A piece that was popped is made.
  void noteMade(StripBatch& batch);
  // A part that was popped is done, and took that long.
  void noteServed(const EncodeTask& task, int64_t duration_ns);
  // Nothing more comes in; what is inside is still handed out.
  void close();
  // Lets go of everything inside.
  void clear();

 private:
  // Until there may be something to take; looks out for a while before it sleeps.
  void waitForMore(std::unique_lock<std::mutex>& lock);
  void noteFilled();
  std::optional<EncodeTask> take();
  void takePack(EncodeTask& task);
  uint32_t sliceRowCount(const EncodeTask& task) const;
  int64_t predictPackNs(const EncodeTask& task, uint32_t row_count) const;
  void dropGivenUp();
  // The batch that the next part is of; nullptr = there is none.
  StripBatchPtr next() const;

  FairShares& shares_;
  std::mutex mutex_;
  std::condition_variable filled_;
  // Changes, under the mutex, whenever there may be something to take where there was nothing.
  std::atomic<uint32_t> fill_count_ = 0;
  uint32_t lookout_count_ = 0;          // of threads that will look at it before they sleep
  std::vector<StripBatchPtr> batches_;  // of which parts are left, as they came
  PackCosts pack_costs_;
  bool is_closed_ = false;
};

}  // namespace viewloom
