// SPDX-License-Identifier: Apache-2.0
// Errors of a command line in the user's words.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace viewloom::usage {

// One line: the command, what is wrong, the nearest names, where help is. `app` has parsed the
// command line and thrown `error`.
std::string usageError(const CLI::App& app, const CLI::ParseError& error);

}  // namespace viewloom::usage
