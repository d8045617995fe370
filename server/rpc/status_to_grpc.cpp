// SPDX-License-Identifier: Apache-2.0
#include "rpc/status_to_grpc.h"

#include <cstdint>
#include <optional>
#include <string>

#include "base/retry_delay.h"
#include "base/status.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace viewloom {
namespace {

// HTTP/2 peers refuse trailers over 8 KiB; message and details both travel there, the latter in
// base64.
constexpr size_t kMessageBytesMax = 1920;

// Tells statuses of this server from those of proxies and of the connection.
constexpr const char* kErrorDomain = "viewloom";

constexpr int64_t kNsPerSecond = 1'000'000'000;

}  // namespace

grpc::Status statusToGrpc(const absl::Status& status) {
  if (status.ok()) return grpc::Status::OK;
  const std::string message(status.message().substr(0, kMessageBytesMax));
  const auto code = static_cast<grpc::StatusCode>(status.code());
  const std::string field = fieldOf(status);
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
