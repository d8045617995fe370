// SPDX-License-Identifier: Apache-2.0
// How the process keeps memory that it has freed.
#pragma once

namespace viewloom {

// Lets the C library keep what is freed for what comes next. Left to itself, glibc gives the memory
// of each received message back to the system and fetches it again for the next one, page by page:
// of a server that receives frames, most of the CPU time (tests/performance.md). Call once, before
// other threads begin. Does nothing with other C libraries.
void keepFreedMemory();

}  // namespace viewloom
