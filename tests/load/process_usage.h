// SPDX-License-Identifier: Apache-2.0
// Use of the machine by a process.
#pragma once

#include <sys/types.h>

#include <cstdint>

namespace viewloom::load {

struct ProcessUsage {
  uint64_t resident_bytes = 0;
  int64_t cpu_ns = 0;  // user and system, all threads, since it began
};

// Throws std::runtime_error when there is no such process.
ProcessUsage usageOf(pid_t process);

}  // namespace viewloom::load
