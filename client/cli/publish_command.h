// SPDX-License-Identifier: Apache-2.0
// `viewloom publish`: sends the synthetic scene, test patterns, files or manifests as a stream.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/command.h"

namespace viewloom::cli {

RunCommand addPublishCommand(CLI::App& app);

}  // namespace viewloom::cli
