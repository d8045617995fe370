// SPDX-License-Identifier: Apache-2.0
// Calls of the reflection service, which needs no token and takes a thread for each call.
#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <memory>
#include <vector>

#include <grpcpp/client_context.h>
#include <grpcpp/completion_queue.h>
#include <grpcpp/generic/generic_stub.h>

#include "e2e/patience.h"
#include "e2e/test_server.h"

namespace viewloom::rpc_reflection_test {
namespace {

constexpr size_t kCalls = 100;
// The server's, and a few of the library that begin with its first calls.
constexpr std::ptrdiff_t kThreadsMax = 40;

std::ptrdiff_t threadCount() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/task"), {});
}

// A call that was begun, and says nothing.
struct IdleCall {
  grpc::ClientContext context;
  std::unique_ptr<grpc::GenericClientAsyncReaderWriter> stream;
  grpc::Status status;
};

TEST(Reflection, refusesCallsThatWouldTakeManyThreads) {
  TestServer server;
  const std::ptrdiff_t thread_count = threadCount();
  grpc::CompletionQueue queue;
  grpc::GenericStub stub(server.connect());
  std::vector<std::unique_ptr<IdleCall>> calls;
  const auto waitForNext = [&queue] {
    void* tag = nullptr;
    bool ok = false;
    return queue.Next(&tag, &ok);
  };
  for (size_t i = 0; i < kCalls; ++i) {
    IdleCall& call = *calls.emplace_back(std::make_unique<IdleCall>());
    endAfterAMinute(call.context);
    call.stream = stub.PrepareCall(
        &call.context, "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo", &queue);
    call.stream->StartCall(nullptr);
    ASSERT_TRUE(waitForNext());
  }
  calls.back()->stream->Finish(&calls.back()->status, nullptr);
  ASSERT_TRUE(waitForNext());  // the server has looked at all of them
  EXPECT_EQ(calls.back()->status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_LT(threadCount(), thread_count + kThreadsMax);
  for (const auto& call : calls) call->context.TryCancel();
}

}  // namespace
}  // namespace viewloom::rpc_reflection_test
