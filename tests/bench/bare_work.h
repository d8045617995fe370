// SPDX-License-Identifier: Apache-2.0
// How evenly the machine itself works: what is the least that anything as long varies by.
#pragma once

#include "load/percentiles.h"

namespace viewloom::bench {

// From when it is due to its end, of arithmetic that touches no memory and takes every core about
// so long, all of them at once, due so many times a second.
load::Percentiles measureBareWork(double work_ms, double rate_hz, double seconds);

}  // namespace viewloom::bench
