// SPDX-License-Identifier: Apache-2.0
// The subcommands of `viewloom` that use the engines of the server themselves.
#pragma once

#include <vector>

#include "cli/command.h"
#include "usage/command_line.h"

namespace viewloom::cli {

// Adds `render` and `bench`. In a build without engines they only say that they are left out.
std::vector<NamedCommand> addOfflineCommands(const usage::Command& app);

}  // namespace viewloom::cli
