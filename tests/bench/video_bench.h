// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench video`: atlases as H.264 beside atlases as JPEG: bytes, error, and CPU time of
// both ends.
#pragma once

#include "usage/command_line.h"

namespace viewloom::bench {

void addVideoCommand(const usage::Command& app);

}  // namespace viewloom::bench
