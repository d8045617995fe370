// SPDX-License-Identifier: Apache-2.0
// The answer to a refused system call: EPERM, and a line on standard error for the first of each
// kind.
#pragma once

namespace viewloom {

// Installs the handler of SIGSYS. Thread-safety: call it once, before the filter is loaded.
void answerRefusedCalls();

}  // namespace viewloom
