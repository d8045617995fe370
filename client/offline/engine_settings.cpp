// SPDX-License-Identifier: Apache-2.0
#include "offline/engine_settings.h"

#include <cstdio>
#include <exception>
#include <memory>
#include <utility>

#include "base/log.h"
#include "base/printable.h"
#include "cli/interrupt.h"
#include "config/read_config.h"
#include "gpu/device_error.h"

namespace viewloom::cli {

RunCommand withEngineSettings(const usage::Command& command,
                              const std::vector<std::string>& beginnings,
                              std::function<int(const Config& config)> act) {
  const auto sources = std::make_shared<ConfigSources>();
  sources->environment = processEnvironment();
  addSettingOptions(command, *sources, beginnings);
  return [name = command.name(), sources, act = std::move(act)](const CommonOptions&) -> int {
    leaveInterrupts();
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

}  // namespace viewloom::cli
