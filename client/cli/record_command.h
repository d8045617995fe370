// SPDX-License-Identifier: Apache-2.0
// `viewloom record`: keeps the atlases of a stream in a file.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/command.h"

namespace viewloom::cli {

RunCommand addRecordCommand(CLI::App& app);

}  // namespace viewloom::cli
