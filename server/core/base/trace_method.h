// SPDX-License-Identifier: Apache-2.0
// Method by which an atlas was rendered (shaders/README.md); the values of proto TraceMethod.
#pragma once

#include <cstdint>

namespace viewloom {

enum class TraceMethod : uint8_t { kWalk, kSweep, kCount };

}  // namespace viewloom
