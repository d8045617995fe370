// SPDX-License-Identifier: Apache-2.0
// Interface between main and the subcommands of viewloomd.
#pragma once

#include <functional>

#include "config/config.h"
#include "usage/command_line.h"

namespace viewloom {

// Does what the subcommand is for. Returns the exit code; throws std::exception, with the remedy,
// when it cannot start (exit code 2).
using RunCommand = std::function<int(const Config& config)>;

// Runs the server until SIGTERM or SIGINT. Blocks the two signals for the whole process, so it must
// run before any thread is started. Returns 0 after an orderly drain, 3 when the device failed.
int serve(const Config& config);

// Each adds its subcommand and options to `app`; `chosen` is set when the command line names it.
void addServeCommand(const usage::Command& app, RunCommand& chosen);
// Returns 1 when a file cannot be written.
void addCertificateCommand(const usage::Command& app, RunCommand& chosen);
// Returns 1 when something must be put right before the server can run.
void addDoctorCommand(const usage::Command& app, RunCommand& chosen);
void addTokenCommand(const usage::Command& app, RunCommand& chosen);

}  // namespace viewloom
