// SPDX-License-Identifier: Apache-2.0
// Calls with one request that does not come.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>

#include "admission/display_price.h"
#include "e2e/silent_calls.h"
#include "e2e/test_server.h"

namespace viewloom::rpc_silent_calls_test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kListStreams = "/viewloom.v1.CatalogService/ListStreams";
constexpr const char* kAdviseSource = "/viewloom.v1.CatalogService/AdviseSource";
constexpr const char* kCheck = "/grpc.health.v1.Health/Check";
constexpr const char* kWatch = "/grpc.health.v1.Health/Watch";

uint64_t connectionBytes() {
  return unboundedMemory().reservedBytes(MemoryUse::kConnections);
}

// Within five seconds. The server may ask itself how it is meanwhile, so that there may be more.
bool reachesConnectionBytes(uint64_t bytes) {
  for (int i = 0; i < 500 && connectionBytes() < bytes; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return connectionBytes() >= bytes;
}

TEST(SilentCalls, takeMemoryOfTheirClientBeforeTheirRequestsCome) {
  constexpr size_t kEach = 8;
  TestServer server;
  const uint64_t before_bytes = connectionBytes();
  SilentCalls calls(server.connect());
  for (const char* method : {kListStreams, kAdviseSource, kCheck, kWatch}) {
    for (size_t i = 0; i < kEach; ++i) ASSERT_TRUE(calls.open(method));
  }
  EXPECT_TRUE(reachesConnectionBytes(before_bytes + kConnectionBytes + 4 * kEach * kOpenCallBytes));
}

TEST(SilentCalls, endWithoutARequestInTime) {
  TestServer server;
  SilentCalls lists(server.connect());
  SilentCalls watches(server.connect());
  ASSERT_TRUE(lists.open(kListStreams) && watches.open(kWatch));
  for (SilentCalls* calls : {&lists, &watches}) {
    const grpc::Status status = calls->endOfLast();
    EXPECT_EQ(status.error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
    EXPECT_THAT(status.error_message(), HasSubstr("no request came within 10 s"));
  }
}

TEST(SilentCalls, areToldThatTheyHaveNoRequest) {
  TestServer server;
  for (const char* method : {kListStreams, kCheck}) {
    SilentCalls calls(server.connect());
    ASSERT_TRUE(calls.open(method));
    calls.closeLast();
    const grpc::Status status = calls.endOfLast();
    EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT) << method;
    EXPECT_THAT(status.error_message(), HasSubstr("has no request"));
  }
}

}  // namespace
}  // namespace viewloom::rpc_silent_calls_test
