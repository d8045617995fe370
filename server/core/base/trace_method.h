// SPDX-License-Identifier: Apache-2.0
// How an atlas was traced (shaders/README.md); the values of proto TraceMethod.
#pragma once

#include <cstdint>

namespace viewloom {

enum class TraceMethod : uint8_t { kWalk, kSweep, kCount };

}  // namespace viewloom
