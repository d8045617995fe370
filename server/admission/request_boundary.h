// SPDX-License-Identifier: Apache-2.0
// The boundary of a request: an exception inside it refuses the request, and others go on. Only
// threads of the engines end the process, whose device may have failed.
#pragma once

#include <exception>
#include <string_view>

#include "base/status.h"

namespace viewloom {

// Logs an exception that ended a part of the server's work, and no more than that: at most one line
// a second. Nothing for a lack of memory, which is no fault of the program. Never throws.
void noteThrown(std::string_view work, const std::exception& thrown) noexcept;

// The status of a request out of which an exception came: outOfMemory() for std::bad_alloc, else
// INTERNAL, and the log says why. The client does not hear what the exception said. Without memory
// for a message it has none.
absl::Status refusalFor(const std::exception& thrown) noexcept;

// The result of the call, an absl::Status or absl::StatusOr; refusalFor() the exception that leaves
// it.
template <typename Call>
auto unlessThrown(const Call& call) -> decltype(call()) {
  try {
    return call();
  } catch (const std::exception& thrown) {
    return refusalFor(thrown);
  }
}

}  // namespace viewloom
