// SPDX-License-Identifier: Apache-2.0
#include "cli/pattern_frames.h"

#include <numbers>
#include <utility>

#include "base/clock.h"
#include "base/str_cat.h"
#include "cli/bounded_options.h"
#include "synthetic/synthetic_wire_frame.h"
#include "usage/command_line.h"

namespace viewloom::cli {
namespace {

constexpr double kNsPerS = 1e9;
constexpr double kRadPerDeg = std::numbers::pi / 180;
constexpr double kConeMin_deg = 1, kConeMax_deg = 120;

}  // namespace

void addPatternOptions(const usage::Command& app, PatternFeedOptions& options) {
  const char* const group = "Content";
  const usage::Option pattern = app.add("--pattern", options.name,
                                        "Publish a still test pattern: view-numbers, "
                                        "parallax-ruler, focal-grid or card")
                                    .oneOf({"view-numbers", "parallax-ruler", "focal-grid", "card"})
                                    .valueName("PATTERN")
                                    .group(group);
  app.add("--views", options.pattern.views.count,
          "Views of the display that the pattern tests, 2 to 512")
      .between(2U, patterns::kPatternViewsMax)
      .defaultText("48")
      .needs(pattern)
      .group(group);
  app.add("--cone", options.cone_deg, "Angle between the outermost of these views, 1 to 120")
      .valueName("DEGREES")
      .defaultText("40")
      .between(kConeMin_deg, kConeMax_deg)
      .needs(pattern)
      .group(group);
  addSizeOption(app, "--view-size", options.pattern.views.size_px, 8192,
                "Size of one of these views, in pixels")
      .defaultText("420x560")
      .needs(pattern)
      .group(group);
}

patterns::PatternOptions patternOptions(const PatternFeedOptions& options) {
  patterns::PatternOptions pattern = options.pattern;
  pattern.kind = patterns::patternFromName(options.name).value_or(pattern.kind);
  pattern.views.cone_rad = options.cone_deg * kRadPerDeg;
  return pattern;
}

absl::StatusOr<std::unique_ptr<PatternFrames>> PatternFrames::make(
    const std::string& name, const patterns::PatternOptions& options, double duration_s) {
  absl::StatusOr<patterns::Pattern> pattern = patterns::makePattern(options);
  if (!pattern.ok()) return pattern.status();
  WireFrame frame;
  addLayeredSource(pattern->camera, pattern->size_px, std::move(pattern->layers), frame)
      .set_connection_tolerance(pattern->connection_tolerance);
  return std::unique_ptr<PatternFrames>(new PatternFrames(
      std::move(frame),
      strCat("pattern ", name, ", ", options.size_px.width, "x", options.size_px.height),
      duration_s));
}

PatternFrames::PatternFrames(WireFrame frame, std::string description, double duration_s)
    : frame_(std::move(frame)),
      description_(std::move(description)),
      duration_s_(duration_s),
      notes_{strCat("the focal plane of the pattern is ", 1 / patterns::kFocalPlane_inv_m,
                    " m away, the default of displays")} {}

absl::StatusOr<std::optional<WireFrame>> PatternFrames::next(double /*elapsed_s*/) {
  if (!frame_) return std::optional<WireFrame>();
  taken_ns_ = SteadyClock().nowNs();
  frame_->header.set_capture_time_ns(captureTimeNs());
  return std::exchange(frame_, std::nullopt);
}

bool PatternFrames::hasEnded() const {
  const double stood_s = static_cast<double>(SteadyClock().nowNs() - taken_ns_) / kNsPerS;
  return duration_s_ > 0 && stood_s >= duration_s_;
}

std::vector<std::string> PatternFrames::takeNotes() {
  return std::exchange(notes_, {});
}

}  // namespace viewloom::cli
