// SPDX-License-Identifier: Apache-2.0
#include "offline/offline_commands.h"

#include "offline/bench_command.h"
#include "offline/render_command.h"

namespace viewloom::cli {

std::vector<NamedCommand> addOfflineCommands(const usage::Command& app) {
  const usage::Command render = app.addCommand(
      "render", "Render a frame from files to picture files, without a server; print a report");
  const usage::Command bench = app.addCommand(
      "bench",
      "Time this machine on the built-in scene, 1920x1080 in two layers, as a Portrait quilt");
  return {{render, addRenderCommand(render)}, {bench, addBenchCommand(bench)}};
}

}  // namespace viewloom::cli
