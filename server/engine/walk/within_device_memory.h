// SPDX-License-Identifier: Apache-2.0
// The boundary where memory of a device, or of this computer for it, runs out.
#pragma once

#include <exception>

#include "engine/engine.h"
#include "gpu/device_error.h"

namespace viewloom {

// Calls it. Throws EngineOutOfMemory, in words for users, where there is no memory left for that;
// other exceptions go on.
template <typename Call>
auto withinDeviceMemory(const Call& call) -> decltype(call()) {
  try {
    return call();
  } catch (const EngineOutOfMemory&) {
    throw;
  } catch (const std::exception& error) {
    if (!isOutOfDeviceMemory(error)) throw;
    throw EngineOutOfMemory(deviceErrorText(error));
  }
}

}  // namespace viewloom
