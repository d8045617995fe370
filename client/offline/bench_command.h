// SPDX-License-Identifier: Apache-2.0
// viewloom bench: what this machine does with the built-in scene on a Looking Glass Portrait.
#pragma once

#include "cli/command.h"
#include "usage/command_line.h"

namespace viewloom::cli {

// Adds the options; what is returned measures and prints JSON.
RunCommand addBenchCommand(const usage::Command& command);

}  // namespace viewloom::cli
