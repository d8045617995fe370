// SPDX-License-Identifier: Apache-2.0
// Options for atlases between the frames of a stream.
#pragma once

#include "usage/command_line.h"
#include "viewloom/v1/display.pb.h"

namespace viewloom::cli {

struct TemporalOptions {
  double output_rate_hz = 0;  // 0 = an atlas a frame
  v1::TemporalMode mode = v1::TEMPORAL_MODE_UNSPECIFIED;
  double bridge_s = 0;
};

// None of them beside `file`, which says it all.
void addTemporalOptions(const usage::Command& app, TemporalOptions& options, usage::Option file);

// Nothing is set without a rate.
void setTemporal(const TemporalOptions& options, v1::Display& display);

}  // namespace viewloom::cli
