// SPDX-License-Identifier: Apache-2.0
// The `viewloom` command.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "lib/channel.h"

namespace viewloom::cli {
namespace {

int run(int argc, char** argv) {
  CLI::App app("Publishes colour and depth to a viewloom server, and watches light fields.",
               "viewloom");
  app.set_version_flag("--version", VIEWLOOM_VERSION);
  app.require_subcommand(1);
  app.fallthrough();
  CommonOptions common{.server = kDefaultAddress};
  app.add_option("--server", common.server, "Address of the server: HOST:PORT or unix:PATH")
      ->envname("VIEWLOOM_SERVER_ADDRESS")
      ->capture_default_str();

  const std::vector<std::pair<CLI::App*, RunCommand>> commands = addCommands(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitDone : kExitUsage;  // 0: --help
  }
  catchInterrupts();
  for (const auto& [command, run_command] : commands) {
    if (command->parsed()) return run_command(common);
  }
  return kExitUsage;
}

}  // namespace
}  // namespace viewloom::cli

int main(int argc, char** argv) {
  try {
    return viewloom::cli::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "viewloom: %s\n", error.what());
    return viewloom::cli::kExitFailed;
  }
}
