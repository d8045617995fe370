// SPDX-License-Identifier: Apache-2.0
// Options that say which test pattern is published, and for which display it is drawn.
#pragma once

#include <string>

#include "patterns/pattern.h"
#include "usage/command_line.h"

namespace viewloom::cli {

struct PatternFeedOptions {
  std::string name;      // "" = none
  double cone_deg = 40;  // replaces that of `pattern`, as the name does its kind
  patterns::PatternOptions pattern;
};

void addPatternOptions(const usage::Command& app, PatternFeedOptions& options);

// What patterns are drawn from. `name` is one that addPatternOptions accepts.
patterns::PatternOptions patternOptions(const PatternFeedOptions& options);

}  // namespace viewloom::cli
