// SPDX-License-Identifier: Apache-2.0
// The `viewloom` command.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

#include "base/heap.h"
#include "base/printable.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/server_options.h"
#include "offline/offline_commands.h"
#include "usage/command_line.h"

namespace viewloom::cli {
namespace {

int run(int argc, char** argv) {
  const usage::CommandLine app(
      "Publishes pictures with depth to a viewloom server, and shows the light fields it returns.",
      "viewloom");
  app.version(VIEWLOOM_VERSION);
  app.requireCommand();
  CommonOptions common{};
  addServerOptions(app, common);

  std::vector<NamedCommand> commands = addCommands(app);
  for (NamedCommand& command : addOfflineCommands(app)) commands.push_back(std::move(command));
  noteMessages(commands, common);
  if (argc <= 1) {
    std::fputs(app.help().c_str(), stdout);
    return kExitDone;
  }
  if (const std::optional<int> code = app.parse(argc, argv)) return *code;
  surviveFileSizeLimit();
  for (const NamedCommand& command : commands) {
    if (!command.syntax.wasNamed()) continue;
    const auto code = command.calls_server ? readServerOptions(common) : std::nullopt;
    return code ? *code : command.run(common);
  }
  return kExitUsage;
}

}  // namespace
}  // namespace viewloom::cli

int main(int argc, char** argv) {
  // gRPC's log is for its developers: what matters to users comes as an error.
  setenv("GRPC_VERBOSITY", "NONE", 0);
  viewloom::keepFreedMemory();
  try {
    return viewloom::cli::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "viewloom: %s\n", viewloom::printable(error.what(), true).c_str());
    return viewloom::cli::kExitFailed;
  }
}
