// SPDX-License-Identifier: Apache-2.0
// The subcommands that run engines of the server, and the settings that those follow here, too.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "config/config.h"
#include "usage/command_line.h"

namespace viewloom::cli {

// Adds settings of viewloomd as options, those whose key begins with one of `beginnings`, and
// --config. The command that is returned reads them and then runs `act`; settings and devices that
// do not exist are errors of usage. Ctrl-C ends it at once.
RunCommand withEngineSettings(const usage::Command& command,
                              const std::vector<std::string>& beginnings,
                              std::function<int(const Config& config)> act);

// Renders one frame from files, on one display, to picture files. The command returns kExitFailed
// when its input is refused.
RunCommand addRenderCommand(const usage::Command& command);
// Measures what this machine does with the built-in scene on a Looking Glass Portrait; prints JSON.
RunCommand addBenchCommand(const usage::Command& command);

}  // namespace viewloom::cli
