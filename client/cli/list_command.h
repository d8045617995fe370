// SPDX-License-Identifier: Apache-2.0
// `viewloom list`: what a server has.
#pragma once

#include "cli/command.h"
#include "usage/command_line.h"

namespace viewloom::cli {

RunCommand addListCommand(const usage::Command& app);

}  // namespace viewloom::cli
