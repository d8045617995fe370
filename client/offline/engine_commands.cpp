// SPDX-License-Identifier: Apache-2.0
#include "offline/engine_commands.h"

#include <cstdio>
#include <exception>
#include <memory>
#include <utility>

#include "base/log.h"
#include "base/printable.h"
#include "config/read_config.h"
#include "gpu/device_error.h"
#include "offline/offline_commands.h"

namespace viewloom::cli {

RunCommand withEngineSettings(const usage::Command& command,
                              const std::vector<std::string>& beginnings,
                              std::function<int(const Config& config)> act) {
  const auto sources = std::make_shared<ConfigSources>();
  sources->environment = processEnvironment();
  addSettingOptions(command, *sources, beginnings);
  return [name = command.name(), sources, act = std::move(act)](const CommonOptions&) -> int {
    try {
      const Config config = readConfig(*sources);
      setLogLevel(logLevelOf(config.log.level));
      return act(config);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "viewloom %s: %s\n", name.c_str(),
                   printable(deviceErrorText(error), true).c_str());
      return kExitUsage;
    }
  };
}

std::vector<NamedCommand> addOfflineCommands(const usage::Command& app) {
  const usage::Command render =
      app.addCommand("render", "Render a frame from files to pictures, without a server");
  const usage::Command bench =
      app.addCommand("bench", "Measure how fast this machine renders the built-in scene");
  return {{render, addRenderCommand(render)}, {bench, addBenchCommand(bench)}};
}

}  // namespace viewloom::cli
