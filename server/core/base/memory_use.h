// SPDX-License-Identifier: Apache-2.0
// Uses of a server's memory.
#pragma once

#include <cstdint>

namespace viewloom {

enum class MemoryUse : uint8_t {
  kProgram,      // code, threads and compiled kernels
  kMessages,     // inside the gRPC library
  kFrames,       // planes on their way in, and decoded
  kStructures,   // frames as engines take them
  kDisplays,     // rays of open displays, and their newest atlases
  kAtlases,      // planes of atlases that are being made
  kViewers,      // an atlas that is being written to each viewer
  kConnections,  // streams, calls and connections
  kCount
};

}  // namespace viewloom
