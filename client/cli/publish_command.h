// SPDX-License-Identifier: Apache-2.0
// `viewloom publish`: sends the synthetic scene, test patterns, files or manifests as a stream.
#pragma once

#include "cli/command.h"
#include "usage/command_line.h"

namespace viewloom::cli {

RunCommand addPublishCommand(const usage::Command& app);

}  // namespace viewloom::cli
