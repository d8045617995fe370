// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench quality`: what the applications of the tracer are worth beside the truth.
#pragma once

#include "usage/command_line.h"

namespace viewloom::bench {

void addQualityCommand(const usage::Command& app);

}  // namespace viewloom::bench
