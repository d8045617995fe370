// SPDX-License-Identifier: Apache-2.0
// `viewloom show`: a stream on a light-field panel, or in a window.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/command.h"

namespace viewloom::cli {

RunCommand addShowCommand(CLI::App& app);

}  // namespace viewloom::cli
