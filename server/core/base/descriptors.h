// SPDX-License-Identifier: Apache-2.0
// File descriptors of this process: how many there may be, and which part may receive connections.
#pragma once

#include <cstdint>

namespace viewloom {

// Descriptors that no connection may take: the device, files, threads and libraries use them.
inline constexpr uint64_t kOwnDescriptors = 256;

// Raises the soft limit of this process to its hard limit, and returns the limit that holds now.
uint64_t raiseDescriptorLimit();

// The limit that holds now.
uint64_t descriptorLimit();

// Most connections at the two ports.
struct ConnectionShares {
  uint32_t grpc = 0;
  uint32_t http = 0;

  bool operator==(const ConnectionShares&) const = default;
};

// Gives both ports what is wanted, if kOwnDescriptors are left below the limit. Otherwise both get
// less, in proportion, and at least one each. So neither port can run out of descriptors, and
// neither can take those of the other.
ConnectionShares shareDescriptors(uint64_t limit, const ConnectionShares& wanted);

}  // namespace viewloom
