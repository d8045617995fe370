// SPDX-License-Identifier: Apache-2.0
// The frame that a stream's defaults are taken from, and when they are taken anew.
#pragma once

#include <cstdint>
#include <string>

#include "frame/stage_times.h"

namespace viewloom {

// Depth that has moved by more than this, from what the defaults were taken from, takes them anew.
inline constexpr double kMovedFactor = 4;
// Within this time of such a move, the next one must exceed the square of the factor: a scene that
// jumps to and fro takes nothing anew with every frame.
inline constexpr int64_t kMoveRest_ns = 1'000'000'000;

enum class DefaultsReason : uint8_t { kFirstFrame, kNewPublisher, kDepthMoved };

// How often a stream's defaults were taken, from 1, and why last.
struct DefaultsTaking {
  uint64_t count = 0;
  DefaultsReason reason = DefaultsReason::kFirstFrame;

  bool operator==(const DefaultsTaking&) const = default;
};

// Whether what displays take from depth has moved by more than the factor: the nearest surfaces,
// the focal plane, or the span of 1/Z where that grew. A frame without surfaces moves nothing.
bool hasDepthMoved(const SourceStats& from, const SourceStats& to, double factor);

// "1.5 to 4 m", of the depth in use.
std::string depthRangeText(const SourceStats& stats);

// Thread-safety: none; one owner.
class TakenDefaults {
 public:
  // The next frame of the stream, of that publisher's session, and when it was built. True where
  // the defaults are those of this frame from now on.
  bool follow(uint64_t session, const SourceStats& stats, int64_t built_ns);
  // Whether follow() would answer true because the session is new.
  bool isBegunBy(uint64_t session, const SourceStats& stats) const;

  // The measurements that they were taken from. Expects a frame.
  const SourceStats& stats() const { return stats_; }
  const DefaultsTaking& taking() const { return taking_; }

 private:
  void take(DefaultsReason reason, const SourceStats& stats, int64_t built_ns);

  SourceStats stats_;
  DefaultsTaking taking_;
  uint64_t session_ = 0;
  double factor_ = kMovedFactor;  // that depth has to move by
  int64_t taken_ns_ = 0;
};

}  // namespace viewloom
