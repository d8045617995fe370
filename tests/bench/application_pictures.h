// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench pictures`: each application of the tracer in pictures.
#pragma once

#include <CLI/CLI.hpp>

namespace viewloom::bench {

void addPicturesCommand(CLI::App& app);

}  // namespace viewloom::bench
