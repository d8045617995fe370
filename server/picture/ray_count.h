// SPDX-License-Identifier: Apache-2.0
// How many rays an atlas takes, before anything of it is laid out.
#pragma once

#include <cstdint>

#include "display/display_spec.h"

namespace viewloom {

// The spec is complete. Rays that are gathered or mirrored are not counted.
int64_t rayCount(const DisplaySpec& spec);

}  // namespace viewloom
