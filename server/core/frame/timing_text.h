// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "frame/timing.h"

namespace viewloom {

// In JSON: "captured", "predicted", "interpolated" or "held".
const char* timingText(Timing timing);

}  // namespace viewloom
