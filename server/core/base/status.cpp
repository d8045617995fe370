// SPDX-License-Identifier: Apache-2.0
#include "base/status.h"

#include "absl/strings/cord.h"
#include "base/retry_delay.h"

namespace viewloom {
namespace {

constexpr std::string_view kFieldPayload = "viewloom.field";
constexpr std::string_view kProblemPayload = "viewloom.problem";

// Debian's absl is built with a string_view of its own.
absl::string_view toAbsl(std::string_view text) {
  return {text.data(), text.size()};
}

std::string payloadOf(const absl::Status& status, std::string_view name) {
  return std::string(status.GetPayload(toAbsl(name)).value_or(absl::Cord()));
}

}  // namespace

absl::Status fieldError(absl::StatusCode code, std::string_view field, std::string_view problem) {
  const std::string message = std::string(field).append(": ").append(problem);
  absl::Status status(code, message);
  status.SetPayload(toAbsl(kFieldPayload), absl::Cord(toAbsl(field)));
  status.SetPayload(toAbsl(kProblemPayload), absl::Cord(toAbsl(problem)));
  return status;
}

absl::Status invalidField(std::string_view field, std::string_view problem) {
  return fieldError(absl::StatusCode::kInvalidArgument, field, problem);
}

std::string fieldOf(const absl::Status& status) {
  return payloadOf(status, kFieldPayload);
}

absl::Status withFieldPrefix(const absl::Status& status, std::string_view prefix) {
  if (status.ok()) return status;
  const std::string field = fieldOf(status);
  const bool is_index = !field.empty() && field.front() == '[';
  const std::string path = std::string(prefix).append(is_index || field.empty() ? "" : ".");
  const absl::Status prefixed =
      field.empty() ? fieldError(status.code(), path, std::string(status.message()))
                    : fieldError(status.code(), path + field, payloadOf(status, kProblemPayload));
  const std::optional<int64_t> delay_ns = retryDelayNs(status);
  return delay_ns ? worthRetry(prefixed, *delay_ns) : prefixed;
}

}  // namespace viewloom
