// SPDX-License-Identifier: Apache-2.0
#include "admission/out_of_memory.h"

#include "base/retry_delay.h"

namespace viewloom {
namespace {

constexpr int64_t kTryAgain_ns = 1'000'000'000;

}  // namespace

absl::Status outOfMemory() {
  return worthRetry(absl::ResourceExhaustedError(
                        "the server's machine has no memory left for this; try again later, or "
                        "lower memory.budget so that less is admitted"),
                    kTryAgain_ns);
}

}  // namespace viewloom
