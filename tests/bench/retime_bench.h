// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench retime`: what it takes to make a frame of a time between frames, where things
// move by themselves.
#pragma once

#include <CLI/CLI.hpp>

namespace viewloom::bench {

void addRetimeCommand(CLI::App& app);

}  // namespace viewloom::bench
