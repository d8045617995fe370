// SPDX-License-Identifier: Apache-2.0
#include "cli/pattern_options.h"

#include <numbers>

#include "cli/size_option.h"
#include "usage/command_line.h"

namespace viewloom::cli {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;
constexpr double kConeMin_deg = 1, kConeMax_deg = 120;

}  // namespace

void addPatternOptions(const usage::Command& app, PatternFeedOptions& options) {
  const char* const group = "What";
  const usage::Option pattern = app.add("--pattern", options.name,
                                        "Publish a test pattern, which stands still: view-numbers, "
                                        "parallax-ruler, focal-grid or card")
                                    .oneOf({"view-numbers", "parallax-ruler", "focal-grid", "card"})
                                    .group(group);
  app.add("--views", options.pattern.views.count,
          "Views of the display that the pattern is for, 2..512 [48]")
      .between(2U, patterns::kPatternViewsMax)
      .needs(pattern)
      .group(group);
  app.add("--cone", options.cone_deg, "Their cone, 1..120 degrees [40]")
      .between(kConeMin_deg, kConeMax_deg)
      .needs(pattern)
      .group(group);
  addSizeOption(app, "--view-size", options.pattern.views.size_px, 8192,
                "Size of one of them [420x560]")
      .needs(pattern)
      .group(group);
}

patterns::PatternOptions patternOptions(const PatternFeedOptions& options) {
  patterns::PatternOptions pattern = options.pattern;
  pattern.kind = patterns::patternFromName(options.name).value_or(pattern.kind);
  pattern.views.cone_rad = options.cone_deg * kRadPerDeg;
  return pattern;
}

}  // namespace viewloom::cli
