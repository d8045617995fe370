// SPDX-License-Identifier: Apache-2.0
#include "e2e/refusal.h"

#include <gtest/gtest.h>

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace viewloom {

Refusal refusalOf(const grpc::Status& status) {
  Refusal refusal{.code = status.error_code()};
  if (status.error_details().empty()) return refusal;
  google::rpc::Status details;
  EXPECT_TRUE(details.ParseFromString(status.error_details()));
  EXPECT_EQ(details.code(), status.error_code());
  EXPECT_EQ(details.message(), status.error_message());
  google::rpc::BadRequest bad_request;
  EXPECT_GE(details.details_size(), 1);
  if (details.details_size() == 0) return refusal;
  if (!details.details(0).UnpackTo(&bad_request)) return refusal;
  EXPECT_EQ(bad_request.field_violations_size(), 1);
  if (bad_request.field_violations_size() == 1) {
    refusal.field = bad_request.field_violations(0).field();
  }
  EXPECT_TRUE(status.error_message().starts_with(refusal.field)) << status.error_message();
  return refusal;
}

std::ostream& operator<<(std::ostream& out, const Refusal& refusal) {
  return out << "code " << refusal.code << " for \"" << refusal.field << '"';
}

}  // namespace viewloom
