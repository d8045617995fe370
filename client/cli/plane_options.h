// SPDX-License-Identifier: Apache-2.0
// Options that say which tool wrote files, what their samples mean, and which camera took them.
#pragma once

#include <CLI/CLI.hpp>

#include "inputs/input_settings.h"

namespace viewloom::cli {

void addPlaneOptions(CLI::App& app, inputs::InputSettings& settings);

}  // namespace viewloom::cli
