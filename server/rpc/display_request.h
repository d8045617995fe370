// SPDX-License-Identifier: Apache-2.0
// The size of requests that describe a display.
#pragma once

#include <cstddef>

namespace viewloom {

// The largest display, of 1024 cameras, has 150 kB.
inline constexpr size_t kDisplayRequestBytesMax = size_t{256} << 10;

}  // namespace viewloom
