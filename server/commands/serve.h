// SPDX-License-Identifier: Apache-2.0
// viewloomd serve: runs the server until SIGTERM or SIGINT.
#pragma once

#include "config/config.h"

namespace viewloom {

// Blocks the two signals for the whole process, so it must run before any thread is started.
// Returns 0 after an orderly drain, 3 when the device failed.
int serve(const Config& config);

}  // namespace viewloom
