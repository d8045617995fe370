// SPDX-License-Identifier: Apache-2.0
// The boundary of one frame's, or one atlas's, work: what runs out of memory is given up alone.
#pragma once

#include <new>

#include "admission/out_of_memory.h"
#include "base/status.h"
#include "engine/engine.h"

namespace viewloom {

// OK, or RESOURCE_EXHAUSTED, in words for users, where the call ran out of memory.
template <typename Call>
absl::Status withinMemory(const Call& call) {
  try {
    call();
  } catch (const EngineOutOfMemory& error) {
    return absl::ResourceExhaustedError(error.what());
  } catch (const std::bad_alloc&) {
    return outOfMemory();
  }
  return absl::OkStatus();
}

}  // namespace viewloom
