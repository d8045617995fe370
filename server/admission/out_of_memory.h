// SPDX-License-Identifier: Apache-2.0
// The refusal for want of memory.
#pragma once

#include "base/status.h"

namespace viewloom {

// RESOURCE_EXHAUSTED: the system had no memory left for it. Worth another try.
absl::Status outOfMemory();

}  // namespace viewloom
