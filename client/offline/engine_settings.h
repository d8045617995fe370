// SPDX-License-Identifier: Apache-2.0
// Settings of the server that its engines follow here, too.
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

}  // namespace viewloom::cli
