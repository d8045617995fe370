// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench uplink`: what a layer of depth costs on its way to the server, by how it is
// packed.
#pragma once

#include <CLI/CLI.hpp>

namespace viewloom::bench {

void addUplinkCommand(CLI::App& app);

}  // namespace viewloom::bench
