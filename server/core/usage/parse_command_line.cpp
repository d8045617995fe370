// SPDX-License-Identifier: Apache-2.0
#include "usage/parse_command_line.h"

#include <cstdio>

#include "usage/usage_error.h"

namespace viewloom::usage {

std::optional<int> parseCommandLine(CLI::App& app, int argc, const char* const* argv) {
  try {
    app.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "%s\n", usageError(app, error).c_str());
    return kExitUsage;
  }
}

}  // namespace viewloom::usage
