// SPDX-License-Identifier: Apache-2.0
// One run of `viewloom publish`: from the first frame to the last report.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "cli/command.h"
#include "cli/frame_feed.h"

namespace viewloom::cli {

struct PublishRunOptions {
  std::string stream = "demo";
  std::string session_id;
  std::optional<double> rate_hz;  // nothing = as kDefaultRate_hz, or as frames bring it along
  bool is_holding = false;
  bool is_quiet = false;
  bool has_no_retry = false;
  int zstd_level = 0;
  std::string depth_encoding = "auto";  // or plain, predicted
  std::string color_encoding = "auto";  // or plain, video
  uint32_t color_qp = 22;               // of video
  std::string record_file;              // "" = none
};

inline constexpr double kDefaultRate_hz = 15;

// The exit code.
int runPublish(const PublishRunOptions& options, const CommonOptions& common,
               std::unique_ptr<FrameFeed> feed);

}  // namespace viewloom::cli
