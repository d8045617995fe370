// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench ingest`: what it costs to get a frame into a server, beside gRPC alone and beside
// a copy of its bytes.
#pragma once

#include "usage/command_line.h"

namespace viewloom::bench {

void addIngestCommand(const usage::Command& app);

}  // namespace viewloom::bench
