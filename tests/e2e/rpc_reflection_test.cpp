// SPDX-License-Identifier: Apache-2.0
// Calls of the reflection service, which needs no token and takes a thread for each call.
#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>

#include "e2e/silent_calls.h"
#include "e2e/test_server.h"

namespace viewloom::rpc_reflection_test {
namespace {

constexpr size_t kCalls = 100;
// The server's, and a few of the library that begin with its first calls.
constexpr std::ptrdiff_t kThreadsMax = 40;

std::ptrdiff_t threadCount() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/task"), {});
}

TEST(Reflection, refusesCallsThatWouldTakeManyThreads) {
  TestServer server;
  const std::ptrdiff_t thread_count = threadCount();
  SilentCalls calls(server.connect());
  for (size_t i = 0; i < kCalls; ++i) {
    ASSERT_TRUE(calls.open("/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo"));
  }
  // The server has looked at all of them then.
  EXPECT_EQ(calls.endOfLast().error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_LT(threadCount(), thread_count + kThreadsMax);
}

}  // namespace
}  // namespace viewloom::rpc_reflection_test
