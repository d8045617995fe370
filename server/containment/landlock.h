// SPDX-License-Identifier: Apache-2.0
// Landlock: the kernel refuses files that are not on a list, whoever asks for them in this process.
#pragma once

#include <cstdint>
#include <vector>

#include "absl/status/status.h"
#include "containment/file_grants.h"

namespace viewloom {

struct LandlockRules {
  std::vector<FileGrant> files;  // those that do not exist are left out
  // TCP ports that may be listened on; 0 = any free port. Connections to others are never allowed.
  // Needs version 4.
  std::vector<uint16_t> listen_ports;
};

// Version of landlock's interface in this kernel, 1 or more; 0 where it has none or leaves it off.
int landlockVersion();

// Holds for the calling thread and all threads that it starts later, for ever: call it before any
// other thread is started. Files that are open stay usable. Needs no_new_privs. `version` is that
// of landlockVersion, or less: 1 = files, 4 = TCP, 5 = control of devices, 6 = abstract sockets and
// signals. Errors: FAILED_PRECONDITION where the kernel refuses.
absl::Status confineByLandlock(const LandlockRules& rules, int version);

}  // namespace viewloom
