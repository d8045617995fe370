// SPDX-License-Identifier: Apache-2.0
// Test patterns as sources of colour and depth, drawn exactly, and the displays that they are drawn
// for.
#pragma once

#include <cstdint>
#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "frame/camera.h"
#include "synthetic/synthetic_frame.h"

namespace viewloom::patterns {

// The display that a pattern is drawn for: where the eyes of its views stand.
// Eyes as viewloomd places those of quilts by default: with t = (i + 0.5) / N - 0.5, view i of N
// stands at D tan(cone t) beside the middle, view 0 leftmost.
struct DisplayViews {
  uint32_t count = 48;
  double cone_rad = 40 * std::numbers::pi / 180;
  SizePx size_px{420, 560};  // of a view

  double angle_rad(uint32_t view) const;
  // x of its eye, as a share of the focal distance.
  double eyeTangent(uint32_t view) const;
  double outermostTangent() const { return eyeTangent(count - 1); }
  // From eye to eye, on average.
  double pitchTangent() const { return 2 * outermostTangent() / (count - 1); }
  // The focal length of a view, px of its width: views show what such a source does of the focal
  // plane, cropped around its middle to their aspect.
  double focalPx(double source_focal_px, SizePx source_px) const;
};

enum class PatternKind : uint8_t { kViewNumbers, kParallaxRuler, kFocalGrid, kCard };

// "view-numbers", ...; nothing for a name that is none.
std::optional<PatternKind> patternFromName(std::string_view name);

struct PatternOptions {
  PatternKind kind = PatternKind::kCard;
  SizePx size_px{1920, 1080};  // of the source
  DisplayViews views;          // what it is drawn for
};

// Where displays that leave their focal plane to the stream put it, within 5e-4: the mean of two
// percentiles of 1/Z. Bins of it begin 32 times an octave. This is the middle of one, so what lies
// evenly around it has it for its mean.
inline constexpr double kFocalPlane_inv_m = 1.5 + 1.0 / 64;
// So much of it surfaces may lie before and behind the plane, to stay in the octave.
inline constexpr double kDepthShareMax = 0.31;

inline constexpr SizePx kPatternMin_px{640, 360};
inline constexpr uint32_t kPatternViewsMax = 512;

// A source at the origin that looks along -z.
struct Pattern {
  Camera camera;
  SizePx size_px;
  std::vector<SyntheticLayer> layers;  // 1 or 2, nearest first
  double connection_tolerance = 0;     // of 1/Z, 1/m: nothing of a pattern is nearly connected
};

// The errors name the options of `viewloom publish`.
absl::StatusOr<Pattern> makePattern(const PatternOptions& options);

}  // namespace viewloom::patterns
