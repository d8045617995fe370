// SPDX-License-Identifier: Apache-2.0
// `viewloom cast`: has Looking Glass Bridge show a stream's quilt.
#pragma once

#include "cli/command.h"
#include "usage/command_line.h"

namespace viewloom::cli {

RunCommand addCastCommand(const usage::Command& app);

}  // namespace viewloom::cli
