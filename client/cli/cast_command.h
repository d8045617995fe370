// SPDX-License-Identifier: Apache-2.0
// `viewloom cast`: has Looking Glass Bridge show a stream's quilt.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/command.h"

namespace viewloom::cli {

RunCommand addCastCommand(CLI::App& app);

}  // namespace viewloom::cli
