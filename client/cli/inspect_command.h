// SPDX-License-Identifier: Apache-2.0
// `viewloom inspect`: what files hold, how they are read, and what looks wrong. Needs no server.
#pragma once

#include "cli/command.h"
#include "usage/command_line.h"

namespace viewloom::cli {

RunCommand addInspectCommand(const usage::Command& app);

}  // namespace viewloom::cli
