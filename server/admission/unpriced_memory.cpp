// SPDX-License-Identifier: Apache-2.0
#include "admission/unpriced_memory.h"

#include <algorithm>

namespace viewloom {

void UnpricedMemory::note(uint64_t resident_bytes) {
  const uint64_t priced_bytes = budget_.reservedBytes() + budget_.idleBytes() - charged_.bytes();
  const uint64_t unpriced_bytes = resident_bytes - std::min(resident_bytes, priced_bytes);
  if (unpriced_bytes <= charged_.bytes()) {
    charged_.shrinkTo(unpriced_bytes);
  } else {
    charged_ = budget_.charge(MemoryUse::kProgram, unpriced_bytes);
  }
}

}  // namespace viewloom
