// SPDX-License-Identifier: Apache-2.0
// `viewloom inspect`: what files hold, how they are read, and what looks wrong. Needs no server.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/command.h"

namespace viewloom::cli {

RunCommand addInspectCommand(CLI::App& app);

}  // namespace viewloom::cli
