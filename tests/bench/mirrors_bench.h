// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench mirrors`: reflections beside those of a march from px to px.
#pragma once

#include "usage/command_line.h"

namespace viewloom::bench {

void addMirrorsCommand(const usage::Command& app);

}  // namespace viewloom::bench
