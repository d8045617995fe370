// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "offline/offline_commands.h"

namespace viewloom::cli {
namespace {

NamedCommand leftOut(const usage::Command& app, const char* name, const char* help) {
  const auto refuse = [name](const CommonOptions&) -> int {
    std::fprintf(stderr,
                 "viewloom %s: this program was built without engines, which make the pictures; "
                 "take one that was built with viewloomd (cmake -DVIEWLOOM_SERVER=ON)\n",
                 name);
    return kExitUsage;
  };
  return {app.addCommand(name, help), refuse};
}

}  // namespace

std::vector<NamedCommand> addOfflineCommands(const usage::Command& app) {
  return {leftOut(app, "render", "Render a frame from files (not in this build)"),
          leftOut(app, "bench", "Time this machine (not in this build)")};
}

}  // namespace viewloom::cli
