// SPDX-License-Identifier: Apache-2.0
// The boundary of a request: when memory runs out inside it, it is refused, and others go on.
#pragma once

#include <new>

#include "base/status.h"

namespace viewloom {

// RESOURCE_EXHAUSTED: the system had no memory left for it. Worth another try.
absl::Status outOfMemory();

// The result of the call, an absl::Status or absl::StatusOr; outOfMemory() where std::bad_alloc
// leaves it.
template <typename Call>
auto unlessOutOfMemory(const Call& call) -> decltype(call()) {
  try {
    return call();
  } catch (const std::bad_alloc&) {
    return outOfMemory();
  }
}

}  // namespace viewloom
