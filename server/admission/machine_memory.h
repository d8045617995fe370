// SPDX-License-Identifier: Apache-2.0
// How much memory this process may have, and how much it has.
#pragma once

#include <cstdint>
#include <filesystem>

namespace viewloom {

// Bytes of the machine, or fewer where a cgroup (version 2 or 1) of this process, or one around it,
// limits them. 0 = the system does not say. `root` is where /proc and /sys are, for tests.
uint64_t machineMemoryBytes(const std::filesystem::path& root = "/");

// Bytes of this process that lie in memory. 0 = the system does not say.
uint64_t residentBytes();
// The same without files, such as programs and libraries: the system can drop those.
uint64_t ownResidentBytes();

}  // namespace viewloom
