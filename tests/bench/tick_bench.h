// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench ticks`: how late the atlases of a display with an output rate are beside a stream
// in which things move by themselves.
#pragma once

#include <CLI/CLI.hpp>

namespace viewloom::bench {

void addTicksCommand(CLI::App& app);

}  // namespace viewloom::bench
