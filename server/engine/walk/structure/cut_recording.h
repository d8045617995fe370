// SPDX-License-Identifier: Apache-2.0
// A recording that may be cut into several submissions of bounded work.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "gpu/commands.h"

namespace viewloom {

// Passes over px record rows one piece after the other and note each. Thread-safety: none.
class CutRecording {
 public:
  // Is told that so many px were recorded since it was told last. May submit the recording, and
  // returns the one that goes on.
  using GoOn = std::function<Commands(uint64_t px_count)>;

  // Never cut.
  explicit CutRecording(Commands commands) : commands_(commands) {}
  // May be cut after about `piece_px_count` px of one pass.
  CutRecording(Commands commands, uint64_t piece_px_count, GoOn go_on)
      : commands_(commands), piece_px_count_(piece_px_count), go_on_(std::move(go_on)) {}

  Commands commands() const { return commands_; }
  uint64_t piecePxCount() const { return piece_px_count_; }
  // Notes recorded px. The recording may be cut here.
  void note(uint64_t px_count) {
    if (go_on_) commands_ = go_on_(px_count);
  }

 private:
  Commands commands_;
  uint64_t piece_px_count_ = UINT64_MAX;
  GoOn go_on_;
};

// Copies piece by piece.
void recordCopy(CutRecording& recording, const Buffer& from, const Buffer& to,
                const CopiedBytes& bytes);

}  // namespace viewloom
