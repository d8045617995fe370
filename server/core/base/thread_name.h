// SPDX-License-Identifier: Apache-2.0
// Names threads for `top -H`, `perf` and debuggers.
#pragma once

namespace viewloom {

// Names the calling thread, and threads that it starts until they get a name. Names are cut to 15
// characters.
void nameThread(const char* name);

}  // namespace viewloom
