// SPDX-License-Identifier: Apache-2.0
// The publisher where a proxy, a hung server or another publisher is in its way.
#include <gtest/gtest.h>

#include <chrono>
#include <future>

#include "e2e/client/publish_scripts.h"
#include "e2e/client/resetting_proxy.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace viewloom::broken_publisher_test {
namespace {

TEST(BrokenPublisher, comesBackAfterWhatAProxyDoesToACall) {
  const grpc::StatusCode codes[] = {grpc::StatusCode::INTERNAL,
                                    grpc::StatusCode::RESOURCE_EXHAUSTED,
                                    grpc::StatusCode::DEADLINE_EXCEEDED};
  std::vector<ReceivedFrame> received;
  const auto serve = [&](PublishStream& stream, int call) {
    if (!accept(stream)) return grpc::Status::OK;
    if (call > 3) return takeAll(stream, received);
    readFrame(stream);
    return grpc::Status(codes[call - 1], "Received RST_STREAM with error code 2");
  };
  ScriptedServer server(serve, noWatching);
  Publisher publisher = makePublisher(server);
  publisher.offer(makeFrame(7));
  EXPECT_EQ(publisher.finish(kLong_ns), absl::OkStatus());
  EXPECT_EQ(received.size(), 1U);
  EXPECT_EQ(publisher.counts().reconnects, 3U);
}

// The frames of HTTP/2 that proxies send when they lose patience.
TEST(BrokenPublisher, comesBackAfterAResetOfItsStream) {
  constexpr uint32_t kInternalError = 2, kRefusedStream = 7, kCancel = 8, kEnhanceYourCalm = 11;
  for (const uint32_t code : {kInternalError, kRefusedStream, kCancel, kEnhanceYourCalm}) {
    std::vector<ReceivedFrame> received;
    ResettingProxy* between = nullptr;
    const auto serve = [&](PublishStream& stream, int call) {
      if (!accept(stream)) return grpc::Status::OK;
      if (call > 1) return takeAll(stream, received);
      v1::PublishFramesRequest request;
      stream.Read(&request);  // of a frame of several messages
      between->resetStream(code);
      while (stream.Read(&request)) {
      }
      return grpc::Status::OK;
    };
    ScriptedServer server(serve, noWatching);
    ResettingProxy proxy(server.address());
    between = &proxy;
    std::vector<absl::Status> reasons;
    PublisherCallbacks callbacks;
    callbacks.on_connection = [&](const ConnectionEvent& event) {
      if (event.kind == ConnectionEvent::Kind::kRetrying) reasons.push_back(event.reason);
    };
    Publisher publisher = makePublisher(proxy.address(), {}, callbacks);
    publisher.offer(makeFrame(7));
    EXPECT_EQ(publisher.finish(kLong_ns), absl::OkStatus()) << code;
    ASSERT_EQ(received.size(), 1U) << code;
    EXPECT_EQ(received[0].planes[0].size(), makeFrame(7).planes[0]->size()) << code;
    ASSERT_EQ(reasons.size(), 1U) << code;
    EXPECT_TRUE(isFromTransport(reasons[0])) << code << ": " << reasons[0];
  }
}

TEST(BrokenPublisher, waitsForItsNameWhereTheServerSaysThatItMay) {
  std::vector<ReceivedFrame> received;
  google::rpc::Status details;
  details.add_details()->PackFrom(google::rpc::RetryInfo());
  const grpc::Status taken(grpc::StatusCode::ALREADY_EXISTS, "taken", details.SerializeAsString());
  const auto serve = [&](PublishStream& stream, int call) {
    if (call <= 3) return taken;
    return accept(stream) ? takeAll(stream, received) : grpc::Status::OK;
  };
  ScriptedServer server(serve, noWatching);
  Publisher publisher = makePublisher(server);
  publisher.offer(makeFrame(7));
  EXPECT_EQ(publisher.finish(kLong_ns), absl::OkStatus());
  EXPECT_EQ(received.size(), 1U);
}

TEST(BrokenPublisher, announcesHeartbeatsAndSendsThemWhileNothingElseGoes) {
  std::promise<void> beats;
  v1::PublishSettings settings;
  const auto serve = [&](PublishStream& stream, int) {
    accept(stream, &settings);
    v1::PublishFramesRequest request;
    for (int count = 0; count < 2 && stream.Read(&request);) count += request.has_heartbeat();
    beats.set_value();
    while (stream.Read(&request)) {
    }
    return grpc::Status::OK;
  };
  ScriptedServer server(serve, noWatching);
  Publisher publisher = makePublisher(server);
  beats.get_future().wait();
  EXPECT_TRUE(settings.sends_heartbeats());
}

TEST(BrokenPublisher, callsAgainWhenAServerWithHeartbeatsFallsSilent) {
  std::promise<void> came_back;
  const auto serve = [&](PublishStream& stream, int call) {
    if (!accept(stream)) return grpc::Status::OK;
    v1::PublishFramesResponse beat;
    beat.mutable_heartbeat();
    stream.Write(beat);
    if (call == 2) came_back.set_value();
    v1::PublishFramesRequest request;
    while (stream.Read(&request)) {
    }
    return grpc::Status::OK;
  };
  ScriptedServer server(serve, noWatching);
  Publisher publisher = makePublisher(server);
  EXPECT_EQ(came_back.get_future().wait_for(std::chrono::nanoseconds(kLong_ns)),
            std::future_status::ready);
}

}  // namespace
}  // namespace viewloom::broken_publisher_test
