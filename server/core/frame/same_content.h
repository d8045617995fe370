// SPDX-License-Identifier: Apache-2.0
// Whether two frames are the same except for their numbers and times.
#pragma once

#include "frame/frame.h"

namespace viewloom {

// Compares sources, cameras, settings, and the meaning and every byte of planes. Their form on the
// wire does not matter. Ends at the first difference.
bool haveSameContent(const Frame& one, const Frame& other);

}  // namespace viewloom
