// SPDX-License-Identifier: Apache-2.0
// The publisher where a proxy, a hung server or another publisher is in its way.
#include <gtest/gtest.h>

#include <chrono>
#include <future>

#include "e2e/client/scripted_server.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "lib/channel.h"
#include "lib/publisher.h"

namespace viewloom {
namespace {

constexpr int64_t kLong_ns = 60'000'000'000;  // only a failing test waits so long
constexpr BackoffOptions kQuick{.first_ns = 1'000'000, .max_ns = 10'000'000, .factor = 2};

// One plane, of one chunk.
WireFrame smallFrame() {
  WireFrame frame;
  frame.header.add_sources()->add_layers()->add_planes()->set_bytes_count(10);
  frame.planes.push_back(std::make_shared<const std::vector<uint8_t>>(10, uint8_t{7}));
  return frame;
}

// Reads settings; false when the call is broken.
bool accept(PublishStream& stream, v1::PublishSettings* settings = nullptr) {
  v1::PublishFramesRequest request;
  if (!stream.Read(&request) || !request.has_settings()) return false;
  if (settings != nullptr) *settings = request.settings();
  v1::PublishFramesResponse response;
  response.mutable_accepted();
  return stream.Write(response);
}

// The number of the next frame, once its bytes have come; 0 = the call is broken.
uint64_t readFrame(PublishStream& stream) {
  uint64_t number = 0;
  v1::PublishFramesRequest request;
  while (stream.Read(&request)) {
    if (request.has_header()) number = request.header().number();
    if (request.has_chunk()) return number;
  }
  return 0;
}

grpc::Status takeAll(PublishStream& stream, int& received_count) {
  while (const uint64_t number = readFrame(stream)) {
    ++received_count;
    v1::PublishFramesResponse response;
    response.mutable_report()->set_number(number);
    response.mutable_report()->set_outcome(v1::FRAME_OUTCOME_TRACED);
    stream.Write(response);
  }
  return grpc::Status::OK;
}

grpc::Status noWatching(WatchStream&, int) {
  return {grpc::StatusCode::UNIMPLEMENTED, "not in this test"};
}

Publisher makePublisher(const ScriptedServer& server) {
  PublisherOptions options;
  options.stream = "s";
  options.backoff = kQuick;
  return Publisher(makeChannel(server.address()), options, {});
}

TEST(BrokenPublisher, comesBackAfterWhatAProxyDoesToACall) {
  const grpc::StatusCode codes[] = {grpc::StatusCode::INTERNAL,
                                    grpc::StatusCode::RESOURCE_EXHAUSTED,
                                    grpc::StatusCode::DEADLINE_EXCEEDED};
  int received_count = 0;
  const auto serve = [&](PublishStream& stream, int call) {
    if (!accept(stream)) return grpc::Status::OK;
    if (call > 3) return takeAll(stream, received_count);
    readFrame(stream);
    return grpc::Status(codes[call - 1], "Received RST_STREAM with error code 2");
  };
  ScriptedServer server(serve, noWatching);
  Publisher publisher = makePublisher(server);
  publisher.offer(smallFrame());
  EXPECT_EQ(publisher.finish(kLong_ns), absl::OkStatus());
  EXPECT_EQ(received_count, 1);
  EXPECT_EQ(publisher.counts().reconnects, 3U);
}

TEST(BrokenPublisher, waitsForItsNameWhereTheServerSaysThatItMay) {
  int received_count = 0;
  google::rpc::Status details;
  details.add_details()->PackFrom(google::rpc::RetryInfo());
  const grpc::Status taken(grpc::StatusCode::ALREADY_EXISTS, "taken", details.SerializeAsString());
  const auto serve = [&](PublishStream& stream, int call) {
    if (call <= 3) return taken;
    return accept(stream) ? takeAll(stream, received_count) : grpc::Status::OK;
  };
  ScriptedServer server(serve, noWatching);
  Publisher publisher = makePublisher(server);
  publisher.offer(smallFrame());
  EXPECT_EQ(publisher.finish(kLong_ns), absl::OkStatus());
  EXPECT_EQ(received_count, 1);
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
}  // namespace viewloom
