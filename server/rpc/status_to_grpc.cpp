// SPDX-License-Identifier: Apache-2.0
#include "rpc/status_to_grpc.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/printable.h"
#include "base/retry_delay.h"
#include "base/status.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace viewloom {
namespace {

// HTTP/2 peers refuse trailers over 8 KiB. The message travels there three times: once with a code
// of three bytes for each byte that is not printable ASCII, and twice in base64, in the details.
constexpr double kMessageCostMax = 7000;
constexpr double kBase64Cost = 4.0 / 3;
constexpr size_t kFieldBytesMax = 256;  // a path in the request; in base64

// Tells statuses of this server from those of proxies and of the connection.
constexpr const char* kErrorDomain = "viewloom";

constexpr int64_t kNsPerSecond = 1'000'000'000;

double costOf(std::string_view character) {
  const char first = character.front();
  const bool is_plain = first >= ' ' && first <= '~' && first != '%';
  const auto size = static_cast<double>(character.size());
  return (is_plain ? size : 3 * size) + 2 * kBase64Cost * size;
}

// The begin of the message that fits, in whole characters.
std::string_view fitting(std::string_view message) {
  double cost = 0;
  size_t end = 0;
  while (end < message.size()) {
    const std::string_view character = firstCharacter(message.substr(end));
    cost += costOf(character);
    if (cost > kMessageCostMax) break;
    end += character.size();
  }
  return message.substr(0, end);
}

}  // namespace

grpc::Status statusToGrpc(const absl::Status& status) {
  if (status.ok()) return grpc::Status::OK;
  const std::string message(fitting({status.message().data(), status.message().size()}));
  const auto code = static_cast<grpc::StatusCode>(status.code());
  const std::string field(wholeCharacters(printable(fieldOf(status)), kFieldBytesMax));
  google::rpc::Status details;
  details.set_code(code);
  details.set_message(message);
  if (!field.empty()) {
    google::rpc::BadRequest bad_request;
    auto& violation = *bad_request.add_field_violations();
    violation.set_field(field);
    violation.set_description(message);
    details.add_details()->PackFrom(bad_request);
  }
  google::rpc::ErrorInfo info;
  info.set_reason(absl::StatusCodeToString(status.code()));
  info.set_domain(kErrorDomain);
  details.add_details()->PackFrom(info);
  if (const std::optional<int64_t> delay_ns = retryDelayNs(status)) {
    google::rpc::RetryInfo retry;
    retry.mutable_retry_delay()->set_seconds(*delay_ns / kNsPerSecond);
    retry.mutable_retry_delay()->set_nanos(static_cast<int32_t>(*delay_ns % kNsPerSecond));
    details.add_details()->PackFrom(retry);
  }
  return grpc::Status(code, message, details.SerializeAsString());
}

}  // namespace viewloom
