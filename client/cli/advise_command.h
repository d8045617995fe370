// SPDX-License-Identifier: Apache-2.0
// `viewloom advise`: says which source would serve a display of a scene between two depths.
#pragma once

#include "cli/command.h"
#include "usage/command_line.h"

namespace viewloom::cli {

RunCommand addAdviseCommand(const usage::Command& app);

}  // namespace viewloom::cli
