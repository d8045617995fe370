// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench displays`: what a frame of each display costs.
#pragma once

#include "usage/command_line.h"

namespace viewloom::bench {

void addDisplaysCommand(const usage::Command& app);

}  // namespace viewloom::bench
