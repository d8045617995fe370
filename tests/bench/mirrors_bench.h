// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench mirrors`: reflections beside those of a march from px to px.
#pragma once

#include <CLI/CLI.hpp>

namespace viewloom::bench {

void addMirrorsCommand(CLI::App& app);

}  // namespace viewloom::bench
