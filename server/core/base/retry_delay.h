// SPDX-License-Identifier: Apache-2.0
// Refusals that may pass: when to ask again.
#pragma once

#include <cstdint>
#include <optional>

#include "base/status.h"

namespace viewloom {

// The same refusal; asking again after so long makes sense.
absl::Status worthRetry(absl::Status status, int64_t delay_ns);

// After how long to ask again; nullopt where nothing was said of that.
std::optional<int64_t> retryDelayNs(const absl::Status& status);

}  // namespace viewloom
