// SPDX-License-Identifier: Apache-2.0
// Gain of a display's quality: time over PSNR, for each application of the tracer.
#pragma once

#include <string>
#include <vector>

#include "bench/knob_loads.h"
#include "gpu/device.h"
#include "usage/command_line.h"

namespace viewloom::bench {

struct KnobPoint {
  std::string application;
  Quality quality = Quality::kBalanced;
  double trace_ms = 0;  // median
  double psnr_db = 0;   // sRGB, of px that the frame knows
};

// Draft, balanced and best in turn, as often as rounds say, at least once.
std::vector<KnobPoint> knobPoints(const Device& device, const KnobLoad& load, uint32_t round_count);

void addKnobCommand(const usage::Command& app);

}  // namespace viewloom::bench
