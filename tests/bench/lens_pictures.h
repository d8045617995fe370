// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench lens-pictures`: what a lens shows, beside the truth, as images.
#pragma once

#include <CLI/CLI.hpp>

namespace viewloom::bench {

void addLensPicturesCommand(CLI::App& app);

}  // namespace viewloom::bench
