// SPDX-License-Identifier: Apache-2.0
#include "base/status.h"

#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"

namespace viewloom {
namespace {

constexpr std::string_view kFieldPayload = "viewloom.field";
constexpr std::string_view kProblemPayload = "viewloom.problem";

}  // namespace

absl::Status fieldError(absl::StatusCode code, std::string_view field, std::string_view problem) {
  absl::Status status(code, absl::StrCat(field, ": ", problem));
  status.SetPayload(kFieldPayload, absl::Cord(field));
  status.SetPayload(kProblemPayload, absl::Cord(problem));
  return status;
}

absl::Status invalidField(std::string_view field, std::string_view problem) {
  return fieldError(absl::StatusCode::kInvalidArgument, field, problem);
}

std::string fieldOf(const absl::Status& status) {
  return std::string(status.GetPayload(kFieldPayload).value_or(absl::Cord()));
}

absl::Status withFieldPrefix(const absl::Status& status, std::string_view prefix) {
  if (status.ok()) return status;
  const std::string field = fieldOf(status);
  if (field.empty()) return fieldError(status.code(), prefix, status.message());
  const std::string problem(*status.GetPayload(kProblemPayload));
  const bool index = field.front() == '[';
  return fieldError(status.code(), absl::StrCat(prefix, index ? "" : ".", field), problem);
}

}  // namespace viewloom
