// SPDX-License-Identifier: Apache-2.0
// Whether two frames are the same but for their number and their times.
#pragma once

#include "frame/frame.h"

namespace viewloom {

// Compares sources, cameras, settings, what planes mean, and every byte of them; how planes came
// over the wire does not count. Ends at the first difference.
bool haveSameContent(const Frame& one, const Frame& other);

}  // namespace viewloom
