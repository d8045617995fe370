// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "offline/offline_commands.h"

namespace viewloom::cli {
namespace {

NamedCommand leftOut(const usage::Command& app, const char* name, const char* help) {
  const auto refuse = [name](const CommonOptions&) -> int {
    std::fprintf(
        stderr,
        "viewloom %s: this program cannot render, because it was built without the "
        "renderer. Use a viewloom that was built with viewloomd (cmake -DVIEWLOOM_SERVER=ON)\n",
        name);
    return kExitUsage;
  };
  return {app.addCommand(name, help), refuse};
}

}  // namespace

std::vector<NamedCommand> addOfflineCommands(const usage::Command& app) {
  return {leftOut(app, "render", "Render a frame from files to pictures (not in this build)"),
          leftOut(app, "bench", "Measure how fast this machine renders (not in this build)")};
}

}  // namespace viewloom::cli
