// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench stereo`: how long tracked eyes wait for what they see.
#pragma once

#include "usage/command_line.h"

namespace viewloom::bench {

void addStereoCommand(const usage::Command& app);

}  // namespace viewloom::bench
