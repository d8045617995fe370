// SPDX-License-Identifier: Apache-2.0
#include "rpc/status_to_grpc.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "base/retry_delay.h"
#include "base/status.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace viewloom::status_to_grpc_test {
namespace {

TEST(StatusToGrpc, keepsEveryCode) {
  const std::pair<absl::StatusCode, grpc::StatusCode> codes[] = {
      {absl::StatusCode::kCancelled, grpc::StatusCode::CANCELLED},
      {absl::StatusCode::kInvalidArgument, grpc::StatusCode::INVALID_ARGUMENT},
      {absl::StatusCode::kNotFound, grpc::StatusCode::NOT_FOUND},
      {absl::StatusCode::kAlreadyExists, grpc::StatusCode::ALREADY_EXISTS},
      {absl::StatusCode::kResourceExhausted, grpc::StatusCode::RESOURCE_EXHAUSTED},
      {absl::StatusCode::kFailedPrecondition, grpc::StatusCode::FAILED_PRECONDITION},
      {absl::StatusCode::kAborted, grpc::StatusCode::ABORTED},
      {absl::StatusCode::kOutOfRange, grpc::StatusCode::OUT_OF_RANGE},
      {absl::StatusCode::kUnimplemented, grpc::StatusCode::UNIMPLEMENTED},
      {absl::StatusCode::kInternal, grpc::StatusCode::INTERNAL},
      {absl::StatusCode::kUnavailable, grpc::StatusCode::UNAVAILABLE}};
  for (const auto& [code, grpc_code] : codes) {
    const grpc::Status status = statusToGrpc(absl::Status(code, "why"));
    EXPECT_EQ(status.error_code(), grpc_code);
    EXPECT_EQ(status.error_message(), "why");
  }
  EXPECT_TRUE(statusToGrpc(absl::OkStatus()).ok());
}

TEST(StatusToGrpc, namesTheFieldInBadRequest) {
  const grpc::Status status =
      statusToGrpc(withFieldPrefix(invalidField("size", "is 0x4"), "header.planes[1]"));
  EXPECT_EQ(status.error_message(), "header.planes[1].size: is 0x4");
  google::rpc::Status details;
  ASSERT_TRUE(details.ParseFromString(status.error_details()));
  EXPECT_EQ(details.code(), grpc::StatusCode::INVALID_ARGUMENT);
  google::rpc::BadRequest bad_request;
  ASSERT_EQ(details.details_size(), 2);
  EXPECT_EQ(details.details(0).type_url(), "type.googleapis.com/google.rpc.BadRequest");
  ASSERT_TRUE(details.details(0).UnpackTo(&bad_request));
  ASSERT_EQ(bad_request.field_violations_size(), 1);
  EXPECT_EQ(bad_request.field_violations(0).field(), "header.planes[1].size");
  EXPECT_EQ(bad_request.field_violations(0).description(), "header.planes[1].size: is 0x4");
}

// The last detail of an error.
template <typename Detail>
Detail lastDetail(const grpc::Status& status) {
  google::rpc::Status details;
  EXPECT_TRUE(details.ParseFromString(status.error_details()));
  Detail detail;
  EXPECT_GT(details.details_size(), 0);
  EXPECT_TRUE(details.details(details.details_size() - 1).UnpackTo(&detail));
  return detail;
}

TEST(StatusToGrpc, tellsErrorsOfTheServerFromThoseOfProxies) {
  const auto info = lastDetail<google::rpc::ErrorInfo>(
      statusToGrpc(absl::ResourceExhaustedError("too many streams")));
  EXPECT_EQ(info.domain(), "viewloom");
  EXPECT_EQ(info.reason(), "RESOURCE_EXHAUSTED");
}

TEST(StatusToGrpc, saysWhenToAskAgain) {
  const absl::Status status = worthRetry(absl::AlreadyExistsError("taken"), 1'250'000'000);
  const auto retry =
      lastDetail<google::rpc::RetryInfo>(statusToGrpc(withFieldPrefix(status, "settings.stream")));
  EXPECT_EQ(retry.retry_delay().seconds(), 1);
  EXPECT_EQ(retry.retry_delay().nanos(), 250'000'000);
}

// Bytes of a message in the headers: three for each that is not printable ASCII.
size_t codedBytes(std::string_view message) {
  size_t bytes = 0;
  for (const char c : message) bytes += c < ' ' || c > '~' || c == '%' ? 3 : 1;
  return bytes;
}

// Message, details and the message in base64 within them travel as one block of HTTP/2 headers, of
// which peers take 8 KiB by default.
TEST(StatusToGrpc, fitsIntoTheHeadersOfAnyPeer) {
  // A letter of each kind: plain, and of two, three and four bytes, which the headers write as
  // codes.
  for (const char* letter : {"x", "%", "\u00e9", "\u5149", "\U0001f30d"}) {
    std::string text;
    while (text.size() < 100000) text += letter;
    const grpc::Status status = statusToGrpc(invalidField(text, text));
    EXPECT_LE(codedBytes(status.error_message()) + status.error_details().size() * 4 / 3, 8000u);
    EXPECT_GT(status.error_message().size(), 1000u);
    EXPECT_EQ(status.error_message().size() % std::string(letter).size(), 0u) << "a torn letter";
  }
}

}  // namespace
}  // namespace viewloom::status_to_grpc_test
