// SPDX-License-Identifier: Apache-2.0
// A test pattern as a feed: options that say which one and for which display, and one frame, which
// then stands.
#pragma once

#include <memory>
#include <string>

#include "cli/frame_feed.h"
#include "lib/wire_frame.h"
#include "patterns/pattern.h"
#include "usage/command_line.h"

namespace viewloom::cli {

struct PatternFeedOptions {
  std::string name;      // "" = none
  double cone_deg = 40;  // replaces that of `pattern`, as the name does its kind
  patterns::PatternOptions pattern;
};

void addPatternOptions(const usage::Command& app, PatternFeedOptions& options);

// Settings of patterns. `name` is one that addPatternOptions accepts.
patterns::PatternOptions patternOptions(const PatternFeedOptions& options);

class PatternFrames final : public FrameFeed {
 public:
  // The errors of makePattern. duration_s: how long it stands; 0 = without end.
  static absl::StatusOr<std::unique_ptr<PatternFrames>> make(
      const std::string& name, const patterns::PatternOptions& options, double duration_s);

  absl::StatusOr<std::optional<WireFrame>> next(double elapsed_s) override;
  bool hasEnded() const override;
  std::string description() const override { return description_; }
  std::vector<std::string> takeNotes() override;
  bool isLive() const override { return false; }

 private:
  PatternFrames(WireFrame frame, std::string description, double duration_s);

  std::optional<WireFrame> frame_;  // until it is taken
  const std::string description_;
  const double duration_s_;
  int64_t taken_ns_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace viewloom::cli
