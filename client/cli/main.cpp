// SPDX-License-Identifier: Apache-2.0
// The `viewloom` command: publish, watch, list, cast.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <vector>

#include "cli/cast_command.h"
#include "cli/command.h"
#include "cli/interrupt.h"
#include "cli/list_command.h"
#include "cli/publish_command.h"
#include "cli/watch_command.h"
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
  std::vector<std::pair<CLI::App*, RunCommand>> commands;
  const auto add = [&](const char* name, const char* description, auto add_command) {
    CLI::App* command = app.add_subcommand(name, description);
    commands.emplace_back(command, add_command(*command));
  };
  add("publish", "Send the synthetic scene, image files or manifests", addPublishCommand);
  add("watch", "Receive atlases of a stream, write them, see how fast they come", addWatchCommand);
  add("list", "Show the streams, displays and presets of a server", addListCommand);
  add("cast", "Have Looking Glass Bridge show a stream", addCastCommand);
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
