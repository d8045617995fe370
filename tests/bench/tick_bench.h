// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench ticks`: how late the atlases of a display with an output rate are beside a stream
// in which things move by themselves.
#pragma once

#include "usage/command_line.h"

namespace viewloom::bench {

void addTicksCommand(const usage::Command& app);

}  // namespace viewloom::bench
