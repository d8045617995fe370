// SPDX-License-Identifier: Apache-2.0
// How well the server's clock is known, and where the time from motion to picture goes, in words.
#pragma once

#include <string>

#include "lib/motion_latency.h"

namespace viewloom::cli {

// "server's clock 0.001204 s ahead, to 0.05 ms"
std::string clockText(const ClockOffset& server);
// "motion to picture 23.1 ms (there 0.4, waited 3.0, made 18.2, back 1.5)"
std::string motionText(const MotionLatency& latency);

}  // namespace viewloom::cli
