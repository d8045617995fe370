// SPDX-License-Identifier: Apache-2.0
// `viewloom show`: a stream on a light-field panel, or in a window.
#pragma once

#include "cli/command.h"
#include "usage/command_line.h"

namespace viewloom::cli {

RunCommand addShowCommand(const usage::Command& app);

}  // namespace viewloom::cli
