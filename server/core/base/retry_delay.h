// SPDX-License-Identifier: Apache-2.0
// Attaches to a status when to try again.
#pragma once

#include <cstdint>
#include <optional>

#include "base/status.h"

namespace viewloom {

// The same status, worth another try after delay_ns.
absl::Status worthRetry(absl::Status status, int64_t delay_ns);

// Time until the next try; nullopt if the status has none.
std::optional<int64_t> retryDelayNs(const absl::Status& status);

}  // namespace viewloom
