// SPDX-License-Identifier: Apache-2.0
// viewloomd: reads the settings and runs a subcommand.
#include <cstdio>
#include <exception>
#include <optional>

#include "base/log.h"
#include "base/printable.h"
#include "commands/command.h"
#include "config/read_config.h"
#include "usage/command_line.h"

namespace {

int run(int argc, char** argv) {
  const viewloom::usage::CommandLine app(
      "Computes the views of light-field displays from pictures with depth.", "viewloomd");
  app.version(VIEWLOOM_VERSION);
  app.footer(
      "viewloomd --help lists all settings; they stand before or after serve and doctor. A file "
      "and the environment\nset the same: VIEWLOOM_GRPC_ADDRESS for --grpc.address. Options beat "
      "the environment, the environment beats the file.\n"
      "To render files or to time this machine: viewloom render, viewloom bench.");
  viewloom::ConfigSources sources{.file = {}, .environment = viewloom::processEnvironment()};
  viewloom::addSettingOptions(app, sources);
  viewloom::RunCommand run_command = viewloom::serve;
  viewloom::addServeCommand(app, run_command);
  viewloom::addDoctorCommand(app, run_command);
  const std::optional<int> code = app.parse(argc, argv);
  if (code) return *code;
  const viewloom::Config config = viewloom::readConfig(sources);
  viewloom::setLogLevel(viewloom::logLevelOf(config.log.level));
  return run_command(config);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "viewloomd: %s\n", viewloom::printable(error.what(), true).c_str());
    return viewloom::usage::kExitUsage;
  }
}
