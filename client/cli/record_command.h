// SPDX-License-Identifier: Apache-2.0
// `viewloom record`: keeps the atlases of a stream in a file.
#pragma once

#include "cli/command.h"
#include "usage/command_line.h"

namespace viewloom::cli {

RunCommand addRecordCommand(const usage::Command& app);

}  // namespace viewloom::cli
