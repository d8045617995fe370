// SPDX-License-Identifier: Apache-2.0
// Effects on the views of a display (proto Effects), and the effort for fields that it leaves open.
#pragma once

#include <cstdint>
#include <optional>

#include "base/status.h"
#include "display/fields.h"

namespace viewloom {

enum class Quality : uint8_t { kDraft, kBalanced, kBest };
inline constexpr Word<Quality> kQualities[] = {
    {"DRAFT", Quality::kDraft}, {"BALANCED", Quality::kBalanced}, {"BEST", Quality::kBest}};

// A thin lens in front of every view (display/lens.h).
struct LensSpec {
  double aperture_radius_m = 0;
  bool has_automatic_aperture = false;
  std::optional<double> focus_distance_m;  // none = the display's focal plane
  uint32_t blades = 0;                     // 0 = round
  double rotation_rad = 0;
  uint32_t walked_count = 0;               // 0 = as quality says
  std::optional<uint32_t> gathered_count;  // none = as quality says
  bool is_exact = false;                   // gathered rays that something may block are walked
};
inline constexpr Word<bool> kGatherModes[] = {{"FAST", false}, {"EXACT", true}};

enum class TemporalMode : uint8_t { kPredict, kInterpolate };
inline constexpr Word<TemporalMode> kTemporalModes[] = {
    {"PREDICT", TemporalMode::kPredict}, {"INTERPOLATE", TemporalMode::kInterpolate}};

// Atlases between the frames of a stream, at a display's own rate.
struct TemporalSpec {
  double output_rate_hz = 0;
  TemporalMode mode = TemporalMode::kPredict;
  double bridge_s = 0;  // 0 = 0.25

  bool operator==(const TemporalSpec&) const = default;
};

// Reflections in mirroring surfaces.
struct ReflectionSpec {
  uint32_t bounce_count = 0;     // along one ray; 0 = as quality says
  uint32_t sample_count = 0;     // rays a px of a rough surface; 0 = as quality says
  uint32_t environment_rgb = 0;  // 0xRRGGBB, sRGB
  bool is_unfiltered = false;    // samples are not smoothed over neighbouring px

  bool operator==(const ReflectionSpec&) const = default;
};

inline constexpr double kOutputRateMax_hz = 240;
inline constexpr uint32_t kWalkedSamplesMax = 64;
inline constexpr uint32_t kGatheredSamplesMax = 256;
inline constexpr uint32_t kReflectionSampleCountMax = 64;

template <SpecOf<LensSpec> Lens, typename Visitor>
void visitFields(Lens& lens, Visitor& visit) {
  visit("aperture_radius_m", lens.aperture_radius_m, Range{0, 10});
  visit("automatic_aperture", lens.has_automatic_aperture);
  visit("focus_distance_m", lens.focus_distance_m, Range{kFocalDistanceMin_m, kFocalDistanceMax_m});
  visit("blades", lens.blades, Range{3, 16, true});
  visit("rotation_rad", lens.rotation_rad, kAnyNumber);
  visit("samples", lens.walked_count, Range{1, kWalkedSamplesMax, true});
  visit("gathered_samples", lens.gathered_count, Range{0, kGatheredSamplesMax});
  visit.word("mode", lens.is_exact, kGatherModes);
}

template <SpecOf<TemporalSpec> Temporal, typename Visitor>
void visitFields(Temporal& temporal, Visitor& visit) {
  visit("output_rate_hz", temporal.output_rate_hz, Range{1, kOutputRateMax_hz});
  visit.word("mode", temporal.mode, kTemporalModes);
  visit("bridge_s", temporal.bridge_s, Range{0, 10});
}

template <SpecOf<ReflectionSpec> Reflection, typename Visitor>
void visitFields(Reflection& reflection, Visitor& visit) {
  visit("bounces", reflection.bounce_count, Range{1, 4, true});
  visit("samples", reflection.sample_count, Range{1, kReflectionSampleCountMax, true});
  visit.color("environment_rgb", reflection.environment_rgb);
  visit("unfiltered", reflection.is_unfiltered);
}

// Fill fields that are left open, after the checks. Errors name the field as in proto LensEffect.
absl::Status settle(LensSpec& lens, Quality quality);
void settle(TemporalSpec& temporal);
void settle(ReflectionSpec& reflection, Quality quality);

}  // namespace viewloom
