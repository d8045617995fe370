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
      "Renders the views of light-field displays from pictures with depth.", "viewloomd");
  app.version(VIEWLOOM_VERSION);
  app.footer(
      "Examples:\n"
      "  viewloomd                                        serve on this machine\n"
      "  viewloomd doctor                                 check this machine first\n"
      "  viewloomd certificate                            make a certificate for a local network\n"
      "  viewloomd serve --open --grpc.address 0.0.0.0:50051 --http.address 0.0.0.0:8080\n"
      "\n"
      "`viewloomd --help` lists all settings. Give them before or after the command, in the file "
      "of\n"
      "--config, or in the environment (VIEWLOOM_GRPC_ADDRESS for --grpc.address). Options "
      "override\n"
      "the environment, and the environment overrides the file.\n"
      "To render files or to measure this machine, use `viewloom render` and `viewloom bench`.");
  viewloom::ConfigSources sources{.file = {}, .environment = viewloom::processEnvironment()};
  viewloom::addSettingOptions(app, sources);
  viewloom::RunCommand run_command = viewloom::serve;
  viewloom::addServeCommand(app, run_command);
  viewloom::addCertificateCommand(app, run_command);
  viewloom::addDoctorCommand(app, run_command);
  viewloom::addTokenCommand(app, run_command);
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
