// SPDX-License-Identifier: Apache-2.0
#include "rpc/one_request_call.h"

#include "base/str_cat.h"

namespace viewloom {

void OneRequestCall::tick() {
  {
    std::lock_guard lock(mutex_);
    if (has_request_ || ending() || !opened_.reaches(kRequestTicks)) return;
  }
  end(absl::DeadlineExceededError(strCat("no request came within ",
                                         kRequestTicks * kTick.count() / 1000,
                                         " s of the call's headers; send it right after them")));
}

absl::Status OneRequestCall::handleMessage(grpc::ByteBuffer& bytes) {
  {
    std::lock_guard lock(mutex_);
    if (std::exchange(has_request_, true)) {
      return absl::InvalidArgumentError("a second request came; accepted is one in each call");
    }
  }
  return handleRequest(bytes);
}

absl::Status OneRequestCall::handleHalfClose() {
  std::lock_guard lock(mutex_);
  if (has_request_) return absl::OkStatus();
  return absl::InvalidArgumentError("the call has no request; send one");
}

absl::Status QuestionCall::handleRequest(grpc::ByteBuffer& bytes) {
  absl::StatusOr<grpc::ByteBuffer> reply = answer_(bytes);
  VIEWLOOM_RETURN_IF_ERROR(reply.status());
  {
    std::lock_guard lock(mutex_);
    reply_ = *std::move(reply);
  }
  end(absl::OkStatus());
  return absl::OkStatus();
}

std::optional<grpc::ByteBuffer> QuestionCall::takeMessage() {
  return std::exchange(reply_, std::nullopt);
}

}  // namespace viewloom
