// SPDX-License-Identifier: Apache-2.0
#include "base/retry_delay.h"

#include <string>

#include "absl/strings/cord.h"
#include "absl/strings/numbers.h"

namespace viewloom {
namespace {

constexpr const char* kPayload = "viewloom.retry_ns";

}  // namespace

absl::Status worthRetry(absl::Status status, int64_t delay_ns) {
  status.SetPayload(kPayload, absl::Cord(std::to_string(delay_ns)));
  return status;
}

std::optional<int64_t> retryDelayNs(const absl::Status& status) {
  const absl::optional<absl::Cord> payload = status.GetPayload(kPayload);
  int64_t delay_ns = 0;
  if (!payload || !absl::SimpleAtoi(std::string(*payload), &delay_ns)) return std::nullopt;
  return delay_ns;
}

}  // namespace viewloom
