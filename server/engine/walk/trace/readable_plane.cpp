// SPDX-License-Identifier: Apache-2.0
#include "trace/readable_plane.h"

namespace viewloom {

ReadablePlane::ReadablePlane(const Device& device, uint64_t size_bytes, const char* name)
    : readback_(device,
                {.size_bytes = size_bytes, .intent = MemoryIntent::kReadback, .debug_name = name}),
      is_direct_(device.info().shares_memory) {
  if (!is_direct_) device_only_ = Buffer(device, {.size_bytes = size_bytes, .debug_name = name});
}

void ReadablePlane::recordReadback(Commands commands, uint64_t size_bytes) const {
  if (isEmpty() || is_direct_) return;
  commands.copy(device_only_, readback_, {.size_bytes = size_bytes});
}

}  // namespace viewloom
