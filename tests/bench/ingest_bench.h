// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench ingest`: what it costs to get a frame into a server and an atlas out of it,
// beside gRPC alone and beside a copy of the bytes.
#pragma once

#include "usage/command_line.h"

namespace viewloom::bench {

void addIngestCommand(const usage::Command& app);

}  // namespace viewloom::bench
