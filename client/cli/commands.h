// SPDX-License-Identifier: Apache-2.0
// The subcommands of `viewloom`.
#pragma once

#include <vector>

#include "cli/command.h"
#include "usage/command_line.h"

namespace viewloom::cli {

// Adds them all, with what each runs.
std::vector<NamedCommand> addCommands(const usage::Command& app);

}  // namespace viewloom::cli
