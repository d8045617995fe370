// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and SIGTERM as a flag, so that calls end in order.
#pragma once

#include <cstdint>

namespace viewloom::cli {

// How long a command that watches may wait before it asks for the flag again.
inline constexpr int64_t kInterruptTick_ns = 50'000'000;

// From now on the first signal raises the flag; the second ends the process at once.
void catchInterrupts();
bool isInterrupted();

// The first signal ends the process again: for commands that only read and print.
void leaveInterrupts();

}  // namespace viewloom::cli
