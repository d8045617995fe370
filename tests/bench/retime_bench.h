// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench retime`: what it takes to make a frame of a time between frames, where things
// move by themselves.
#pragma once

#include "frame/frame.h"
#include "usage/command_line.h"

namespace viewloom::bench {

// The frame with planes of motion: in the middle of each side, so that this share of all px moves;
// none where that is 0.
FramePtr withMotion(const Frame& still, double share);

void addRetimeCommand(const usage::Command& app);

}  // namespace viewloom::bench
