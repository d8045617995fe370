// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench uplink`: what a layer of depth costs on its way to the server, by how it is
// packed.
#pragma once

#include "usage/command_line.h"

namespace viewloom::bench {

void addUplinkCommand(const usage::Command& app);

}  // namespace viewloom::bench
