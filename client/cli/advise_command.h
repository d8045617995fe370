// SPDX-License-Identifier: Apache-2.0
// `viewloom advise`: says which source would serve a display of a scene between two depths.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/command.h"

namespace viewloom::cli {

RunCommand addAdviseCommand(CLI::App& app);

}  // namespace viewloom::cli
