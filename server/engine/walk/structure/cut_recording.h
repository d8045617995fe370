// SPDX-License-Identifier: Apache-2.0
// A recording that may be cut into several submissions of bounded work.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "gpu/commands.h"
#include "structure/build_costs.h"

namespace viewloom {

// Passes over px record rows one piece after the other, as many as takeRows() says each time.
// Thread-safety: none.
class CutRecording {
 public:
  // Submits what was recorded since the last time, and waits for it. Returns the recording that
  // goes on.
  using GoOn = std::function<Commands(const BuiltPx& recorded)>;

  // Never cut.
  explicit CutRecording(Commands commands) : commands_(commands) {}
  // Cut so that a piece is predicted to take `piece_ns` at most, or has a single row. The costs
  // outlive it.
  CutRecording(Commands commands, const BuildCosts& costs, int64_t piece_ns, GoOn go_on)
      : commands_(commands), costs_(&costs), piece_ns_(piece_ns), go_on_(std::move(go_on)) {}

  // Where the next rows are recorded; not that one any more after takeRows() or cut().
  Commands commands() const { return commands_; }
  // Rows of so many px that a pass is to record next, 1 to row_count. Cuts before them, unless they
  // fit into the piece.
  uint64_t takeRows(BuildPass pass, uint64_t row_px_count, uint64_t row_count);
  // Whether so many px of a pass are more than a piece.
  bool isLong(BuildPass pass, uint64_t px_count) const;
  // Cuts here, unless it is never cut: the CPU may read what was written so far.
  void cut();
  // Px that were recorded since it was cut last.
  const BuiltPx& recorded() const { return recorded_; }

 private:
  Commands commands_;
  const BuildCosts* costs_ = nullptr;
  int64_t piece_ns_ = 0;
  GoOn go_on_;
  BuiltPx recorded_;
};

// Copies piece by piece.
void recordCopy(CutRecording& recording, const Buffer& from, const Buffer& to,
                const CopiedBytes& bytes);
// Fills words of a buffer piece by piece, from an offset on. Both are multiples of 4.
void recordFill(CutRecording& recording, const Buffer& target, uint64_t offset, uint64_t size_bytes,
                uint32_t word);

}  // namespace viewloom
