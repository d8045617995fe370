// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench displays`: what a frame of each display costs.
#pragma once

#include <CLI/CLI.hpp>

namespace viewloom::bench {

void addDisplaysCommand(CLI::App& app);

}  // namespace viewloom::bench
