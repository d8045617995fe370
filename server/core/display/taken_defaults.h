// SPDX-License-Identifier: Apache-2.0
// Decides from which frames a stream's defaults are taken.
#pragma once

#include <cstdint>
#include <string>

#include "frame/stage_times.h"

namespace viewloom {

// Factor by which depth must move before the defaults are taken again.
inline constexpr double kMovedFactor = 4;
// Time after such a move in which the next one must exceed the square of the factor. So a scene
// that jumps to and fro does not take new defaults with every frame.
inline constexpr int64_t kMoveRest_ns = 1'000'000'000;

enum class DefaultsReason : uint8_t { kFirstFrame, kNewPublisher, kDepthMoved };

// Number of times that a stream's defaults were taken, from 1, and the last reason.
struct DefaultsTaking {
  uint64_t count = 0;
  DefaultsReason reason = DefaultsReason::kFirstFrame;

  bool operator==(const DefaultsTaking&) const = default;
};

// Whether depth has moved by more than the factor: the nearest surfaces, the focal plane, or a span
// of 1/Z that grew. A frame without surfaces counts as not moved.
bool hasDepthMoved(const SourceStats& from, const SourceStats& to, double factor);

// Text of the depth in use: "1.5 to 4 m".
std::string depthRangeText(const SourceStats& stats);

// Defaults of one stream. Thread-safety: none; one owner.
class TakenDefaults {
 public:
  // Takes the next frame of the stream, its publisher's session and the time when it was built.
  // Returns true if the defaults now come from this frame.
  bool follow(uint64_t session, const SourceStats& stats, int64_t built_ns);
  // Whether follow() would return true because the session is new.
  bool isBegunBy(uint64_t session, const SourceStats& stats) const;

  // Measurements of the frame that they were taken from. Expects that there was one.
  const SourceStats& stats() const { return stats_; }
  const DefaultsTaking& taking() const { return taking_; }

 private:
  void take(DefaultsReason reason, const SourceStats& stats, int64_t built_ns);

  SourceStats stats_;
  DefaultsTaking taking_;
  uint64_t session_ = 0;
  double factor_ = kMovedFactor;  // for the next move
  int64_t taken_ns_ = 0;
};

}  // namespace viewloom
