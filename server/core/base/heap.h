// SPDX-License-Identifier: Apache-2.0
// The heap: what is lent of it, and when freed memory goes back to the system.
#pragma once

#include <cstdint>

namespace viewloom {

// Makes the C library keep freed memory for the next use. By default, glibc returns the memory of
// each received message to the system and fetches it again for the next one, page by page. In a
// server that receives frames, that takes most of the CPU time (tests/performance.md). Makes
// threads share few heaps, so that fewer pages stay of which only a part is in use. Call once,
// before other threads begin. Does nothing with other C libraries.
void keepFreedMemory();

// Gives all freed memory back to the system. Takes milliseconds, so call it after large releases
// only. Does nothing with other C libraries. Thread-safety: any thread.
void returnFreedMemory();

// Bytes that the C library has lent to the whole process, blocks that are mapped one by one
// included. Blocks that a thread keeps for its own next use count. 0 with other C libraries, and
// under sanitizers. Walks through all free blocks, so call it seldom. Thread-safety: any thread.
uint64_t lentHeapBytes();

}  // namespace viewloom
