// SPDX-License-Identifier: Apache-2.0
// Keeps freed memory in the process, and gives it back.
#pragma once

namespace viewloom {

// Makes the C library keep freed memory for the next use. By default, glibc returns the memory of
// each received message to the system and fetches it again for the next one, page by page. In a
// server that receives frames, that takes most of the CPU time (tests/performance.md). Call once,
// before other threads begin. Does nothing with other C libraries.
void keepFreedMemory();

// Gives all freed memory back to the system. Takes milliseconds, so call it after large releases
// only. Does nothing with other C libraries. Thread-safety: any thread.
void returnFreedMemory();

}  // namespace viewloom
