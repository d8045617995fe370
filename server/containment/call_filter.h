// SPDX-License-Identifier: Apache-2.0
// Seccomp: the kernel refuses system calls that a server does not make.
#pragma once

#include "absl/status/status.h"

namespace viewloom {

// Holds for all threads of the process, those that run included, for ever. Needs no_new_privs.
//
// Calls of kDeadlyCalls end the process. Other calls off the list return EPERM, and the first of
// each kind is logged: a driver or a library of tomorrow may make one, and that must not end the
// server for everybody. Call it when devices are open: drivers do more when they begin.
// Errors: FAILED_PRECONDITION where the kernel has no seccomp.
absl::Status refuseOtherCalls();

}  // namespace viewloom
