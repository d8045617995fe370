// SPDX-License-Identifier: Apache-2.0
// Options that say how atlases are packed on their way.
#pragma once

#include <cstdint>
#include <string>

#include "base/status.h"
#include "usage/command_line.h"
#include "viewloom/v1/atlas.pb.h"

namespace viewloom::cli {

struct EncodingOptions {
  std::string json;  // AtlasEncoding; or what follows
  uint32_t jpeg_quality = 85;
  bool is_444 = false;
  bool is_lossless = false;
  bool is_h264 = false;
  bool is_chained = false;  // each atlas of H.264 refers to the one before
  uint32_t mbit_max = 0;    // a second, of H.264; 0 = as many as the line takes
  bool has_mask = false;
};

void addEncodingOptions(const usage::Command& app, EncodingOptions& options);
void addMaskOption(const usage::Command& app, EncodingOptions& options);

absl::StatusOr<v1::AtlasEncoding> makeEncoding(const EncodingOptions& options);

}  // namespace viewloom::cli
