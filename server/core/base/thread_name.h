// SPDX-License-Identifier: Apache-2.0
// Names of threads, as `top -H`, `perf` and debuggers show them.
#pragma once

namespace viewloom {

// Names the calling thread, and those that it begins until they are named. At most 15 characters:
// what is beyond is cut off.
void nameThread(const char* name);

}  // namespace viewloom
