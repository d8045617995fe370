// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench stereo`: how long tracked eyes wait for what they see.
#pragma once

#include <CLI/CLI.hpp>

namespace viewloom::bench {

void addStereoCommand(CLI::App& app);

}  // namespace viewloom::bench
