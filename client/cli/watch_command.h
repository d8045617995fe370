// SPDX-License-Identifier: Apache-2.0
// `viewloom watch`: receives atlases of a stream, writes them, and says how it goes.
#pragma once

#include "cli/command.h"
#include "usage/command_line.h"

namespace viewloom::cli {

RunCommand addWatchCommand(const usage::Command& app);

}  // namespace viewloom::cli
