// SPDX-License-Identifier: Apache-2.0
// Options that say which tool wrote files, what their samples mean, and which camera took them.
#pragma once

#include "inputs/input_settings.h"
#include "usage/command_line.h"

namespace viewloom::cli {

void addPlaneOptions(const usage::Command& app, inputs::InputSettings& settings);

}  // namespace viewloom::cli
