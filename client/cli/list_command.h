// SPDX-License-Identifier: Apache-2.0
// `viewloom list`: what a server has.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/command.h"

namespace viewloom::cli {

RunCommand addListCommand(CLI::App& app);

}  // namespace viewloom::cli
