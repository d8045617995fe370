// SPDX-License-Identifier: Apache-2.0
// `viewloom-bench pictures`: each application of the tracer in pictures.
#pragma once

#include "usage/command_line.h"

namespace viewloom::bench {

void addPicturesCommand(const usage::Command& app);

}  // namespace viewloom::bench
