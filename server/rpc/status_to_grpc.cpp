// SPDX-License-Identifier: Apache-2.0
#include "rpc/status_to_grpc.h"

#include <string>

#include "base/status.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace viewloom {
namespace {

// HTTP/2 peers refuse trailers over 8 KiB; message and details both travel there, the latter in
// base64.
constexpr size_t kMessageBytesMax = 2048;

}  // namespace

grpc::Status statusToGrpc(const absl::Status& status) {
  if (status.ok()) return grpc::Status::OK;
  const std::string message(status.message().substr(0, kMessageBytesMax));
  const auto code = static_cast<grpc::StatusCode>(status.code());
  const std::string field = fieldOf(status);
  if (field.empty()) return grpc::Status(code, message);

  google::rpc::BadRequest bad_request;
  auto& violation = *bad_request.add_field_violations();
  violation.set_field(field);
  violation.set_description(message);
  google::rpc::Status details;
  details.set_code(code);
  details.set_message(message);
  details.add_details()->PackFrom(bad_request);
  return grpc::Status(code, message, details.SerializeAsString());
}

}  // namespace viewloom
