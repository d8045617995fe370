// SPDX-License-Identifier: Apache-2.0
// Settings as options of a command line.
#pragma once

#include <string>
#include <vector>

#include "config/read_config.h"
#include "usage/command_line.h"

namespace viewloom {

// Adds --config and settings: --grpc.address, --device and so on, those whose key begins with one
// of `beginnings`, or all. What the command line names lands in `sources`, which must live until it
// is parsed.
void addSettingOptions(const usage::Command& command, ConfigSources& sources,
                       const std::vector<std::string>& beginnings = {""});

}  // namespace viewloom
