// SPDX-License-Identifier: Apache-2.0
// viewloom render: one frame from files, on one display, to picture files.
#pragma once

#include "cli/command.h"
#include "usage/command_line.h"

namespace viewloom::cli {

// Adds the options; what is returned renders, and returns kExitFailed when its input is refused.
RunCommand addRenderCommand(const usage::Command& command);

}  // namespace viewloom::cli
