// SPDX-License-Identifier: Apache-2.0
// Bytes that the kernel holds for a client that does not read.
#pragma once

#include <cstdint>

namespace viewloom {

// Bytes that the kernel takes of a writer before it could send them.
inline constexpr uint32_t kUnsentBytesMax = uint32_t{128} << 10;
// Memory that the kernel takes for them: a quarter more, for its own structures and for the last
// buffer that it takes whole. Linux 6 took 150 kB of 131 kB, with writes of 1 kB to 1 MB.
inline constexpr uint32_t kSendQueueBytes = kUnsentBytesMax + kUnsentBytesMax / 4;

// Sets that limit for a TCP socket. Without it, the kernel takes 4 MB for each client that never
// reads. What is on its way to a client that does read is not limited, so the speed stays. Does
// nothing for other sockets; those of UNIX have a limit of 208 KiB. Thread-safety: as setsockopt.
void limitSendQueue(int fd);

}  // namespace viewloom
