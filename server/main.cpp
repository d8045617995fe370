// SPDX-License-Identifier: Apache-2.0
// viewloomd: reads the settings and runs a subcommand.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <optional>

#include "base/log.h"
#include "base/printable.h"
#include "commands/command.h"
#include "commands/serve.h"
#include "config/read_config.h"
#include "config/settings.h"
#include "gpu/device_error.h"
#include "usage/parse_command_line.h"

namespace {

// Every setting as a flag: --grpc.address, --device, ...
void addSettings(CLI::App& app, viewloom::ConfigSources& sources) {
  app.add_option("--config", sources.file, "Settings as TOML; see deploy/viewloomd.example.toml");
  viewloom::Config defaults;
  for (const viewloom::Setting& setting : viewloom::settingsOf(defaults)) {
    const std::string key(setting.key);
    app.add_option_function<std::string>(
           "--" + key, [&sources, key](const std::string& text) { sources.flags[key] = text; },
           viewloom::acceptedText(setting))
        ->group("Settings");
  }
}

int run(int argc, char** argv) {
  CLI::App app("Computes the views of light-field displays from pictures with depth.", "viewloomd");
  app.set_version_flag("--version", VIEWLOOM_VERSION);
  app.require_subcommand(0, 1);
  viewloom::ConfigSources sources{.file = {}, .environment = viewloom::processEnvironment()};
  addSettings(app, sources);
  viewloom::Command command = viewloom::serve;
  viewloom::addServeCommand(app, command);
  viewloom::addRenderCommand(app, command);
  viewloom::addBenchCommand(app, command);
  viewloom::addDoctorCommand(app, command);
  const std::optional<int> code = viewloom::usage::parseCommandLine(app, argc, argv);
  if (code) return *code;
  const viewloom::Config config = viewloom::readConfig(sources);
  viewloom::setLogLevel(viewloom::logLevelOf(config.log.level));
  return command(config);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "viewloomd: %s\n",
                 viewloom::printable(viewloom::deviceErrorText(error), true).c_str());
    return viewloom::usage::kExitUsage;
  }
}
