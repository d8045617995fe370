// SPDX-License-Identifier: Apache-2.0
// `viewloom watch`: receives atlases of a stream, writes them, and says how it goes.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/command.h"

namespace viewloom::cli {

RunCommand addWatchCommand(CLI::App& app);

}  // namespace viewloom::cli
