// SPDX-License-Identifier: Apache-2.0
// Calls that watch the health of the server, for which nobody needs a token.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include <grpcpp/client_context.h>

#include "e2e/patience.h"
#include "e2e/test_server.h"
#include "grpc/health/v1/health.grpc.pb.h"
#include "rpc/health_service.h"

namespace viewloom::rpc_health_test {
namespace {

namespace health = grpc::health::v1;

struct Watch {
  grpc::ClientContext context;
  std::unique_ptr<grpc::ClientReader<health::HealthCheckResponse>> reader;
};

TEST(HealthService, leavesWatchesOfItsHealthToOtherClients) {
  constexpr size_t kOnOneConnection = 100;
  TestServer server;
  std::vector<std::unique_ptr<Watch>> watches;
  std::unique_ptr<health::Health::Stub> stub;
  const auto isOpened = [&] {
    if (watches.size() % kOnOneConnection == 0) stub = health::Health::NewStub(server.connect());
    watches.push_back(std::make_unique<Watch>());
    endAfterAMinute(watches.back()->context);
    watches.back()->reader = stub->Watch(&watches.back()->context, {});
    health::HealthCheckResponse response;
    return watches.back()->reader->Read(&response);
  };
  while (watches.size() <= kHealthCallsMax && isOpened()) {
  }
  EXPECT_EQ(watches.size(), kHealthCallsMax * 3 / 4 + 1);
  EXPECT_EQ(watches.back()->reader->Finish().error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  for (const auto& watch : watches) watch->context.TryCancel();
}

TEST(HealthService, tellsWatchersOfServicesThatItDoesNotHave) {
  TestServer server;
  Watch watch;
  endAfterAMinute(watch.context);
  health::HealthCheckRequest request;
  request.set_service("viewloom.v1.Nonsense");
  watch.reader = health::Health::NewStub(server.connect())->Watch(&watch.context, request);
  health::HealthCheckResponse response;
  ASSERT_TRUE(watch.reader->Read(&response));
  EXPECT_EQ(response.status(), health::HealthCheckResponse::SERVICE_UNKNOWN);
  watch.context.TryCancel();
}

}  // namespace
}  // namespace viewloom::rpc_health_test
