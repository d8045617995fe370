// SPDX-License-Identifier: Apache-2.0
// The subcommands of `viewloom`.
#pragma once

#include <CLI/CLI.hpp>

#include <utility>
#include <vector>

#include "cli/command.h"

namespace viewloom::cli {

// Adds them all, with what each runs.
std::vector<std::pair<CLI::App*, RunCommand>> addCommands(CLI::App& app);

}  // namespace viewloom::cli
