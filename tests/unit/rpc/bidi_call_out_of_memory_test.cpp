// SPDX-License-Identifier: Apache-2.0
// An exception between open() and the end of a call would keep the call for ever.
#include "rpc/bidi_call.h"

#include <gtest/gtest.h>

#include <memory>
#include <new>
#include <optional>
#include <string>

#include "admission/request_boundary.h"
#include "fuzz/scripted_stream.h"
#include "support/failing_allocations.h"

namespace viewloom::bidi_call_out_of_memory_test {
namespace {

class SilentCall final : public BidiCall {
 private:
  absl::Status handleMessage(grpc::ByteBuffer&) override { return absl::OkStatus(); }
  absl::Status handleHalfClose() override { return absl::OkStatus(); }
  void release() override {}
  std::optional<grpc::ByteBuffer> takeMessage() override { return std::nullopt; }
};

// So long that its copy is an allocation that may fail.
absl::Status longStatus() {
  return invalidField(std::string(test::kMayFail_bytes, 'f'),
                      std::string(test::kMayFail_bytes, 'm'));
}

TEST(BidiCallOutOfMemory, endsACallThatIsTurnedAway) {
  auto call = std::make_shared<SilentCall>();
  const std::weak_ptr<SilentCall> gone = call;
  ScriptedStream stream(call);
  call->end(longStatus());
  test::failAllocation(0);
  EXPECT_NO_THROW(call->open());
  test::stopFailing();
  call.reset();
  stream.settle();
  EXPECT_TRUE(stream.hasEnded());
  EXPECT_TRUE(gone.expired());
}

TEST(BidiCallOutOfMemory, endsACallWhoseStatusHasNoRoom) {
  const auto call = std::make_shared<SilentCall>();
  ScriptedStream stream(call);
  call->open();
  const absl::Status status = longStatus();
  test::failAllocation(0);
  EXPECT_NO_THROW(call->end(status));
  test::stopFailing();
  stream.halfClose();
  stream.settle();
  EXPECT_TRUE(stream.hasEnded());
}

static_assert(noexcept(refusalFor(std::bad_alloc())), "it is called where nobody catches");

}  // namespace
}  // namespace viewloom::bidi_call_out_of_memory_test
