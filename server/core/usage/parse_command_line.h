// SPDX-License-Identifier: Apache-2.0
// Reads a command line, and says what is wrong with it.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>

namespace viewloom::usage {

inline constexpr int kExitUsage = 2;

// Nothing when the command line is right. Else the exit code, after help or an error was printed: 0
// for --help and --version, kExitUsage for an error.
std::optional<int> parseCommandLine(CLI::App& app, int argc, const char* const* argv);

}  // namespace viewloom::usage
