// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench quality`: what the applications of the tracer are worth beside the truth.
#pragma once

#include <CLI/CLI.hpp>

namespace viewloom::bench {

void addQualityCommand(CLI::App& app);

}  // namespace viewloom::bench
