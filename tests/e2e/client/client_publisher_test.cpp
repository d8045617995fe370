// SPDX-License-Identifier: Apache-2.0
// The publisher against a server that takes, refuses, stalls and breaks off.
#include "lib/publisher.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zstd.h>

#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "e2e/client/publish_scripts.h"
#include "lib/channel.h"

namespace viewloom::client_publisher_test {
namespace {

using ::testing::ElementsAre;

std::string bytesOf(const SharedBytes& bytes) {
  return {bytes->begin(), bytes->end()};
}

TEST(ClientPublisher, sendsWholeFramesInOrderAndGetsTheirReports) {
  std::vector<ReceivedFrame> received;
  const auto serve = [&](PublishStream& stream, int) {
    return accept(stream) ? takeAll(stream, received) : grpc::Status::OK;
  };
  ScriptedServer server(serve, noWatching);
  std::vector<uint64_t> reported;
  PublisherCallbacks callbacks;
  callbacks.on_report = [&](const v1::FrameReport& frame) { reported.push_back(frame.number()); };
  Publisher publisher = makePublisher(server, {}, callbacks);
  const WireFrame frame = makeFrame(3);
  publisher.offer(frame);
  EXPECT_EQ(publisher.finish(kLong_ns), absl::OkStatus());
  ASSERT_EQ(received.size(), 1U);
  EXPECT_EQ(received[0].header.number(), 1U);
  EXPECT_EQ(received[0].planes[0], bytesOf(frame.planes[0]));
  EXPECT_EQ(received[0].planes[1], bytesOf(frame.planes[1]));
  EXPECT_THAT(reported, ElementsAre(1));
  EXPECT_EQ(publisher.counts().sent_bytes, 2'500'010U);
}

TEST(ClientPublisher, compressesPlanesWhenAsked) {
  std::vector<ReceivedFrame> received;
  const auto serve = [&](PublishStream& stream, int) {
    return accept(stream) ? takeAll(stream, received) : grpc::Status::OK;
  };
  ScriptedServer server(serve, noWatching);
  Publisher publisher = makePublisher(server, {.stream = {}, .session_id = {}, .zstd_level = 1});
  const WireFrame frame = makeFrame(3);
  publisher.offer(frame);
  ASSERT_EQ(publisher.finish(kLong_ns), absl::OkStatus());
  ASSERT_EQ(received.size(), 1U);
  EXPECT_EQ(received[0].header.sources(0).layers(0).planes(0).compression(),
            v1::PLANE_COMPRESSION_ZSTD);
  std::string plane(frame.planes[0]->size(), '\0');
  EXPECT_EQ(ZSTD_decompress(plane.data(), plane.size(), received[0].planes[0].data(),
                            received[0].planes[0].size()),
            plane.size());
  EXPECT_EQ(plane, bytesOf(frame.planes[0]));
}

TEST(ClientPublisher, sendsTheNewestFrameWhenTheServerIsSlow) {
  std::promise<void> has_first, may_report;
  std::vector<ReceivedFrame> received;
  const auto serve = [&](PublishStream& stream, int) {
    if (!accept(stream)) return grpc::Status::OK;
    received.push_back(*readFrame(stream));
    has_first.set_value();
    may_report.get_future().wait();
    report(stream, 1);
    return takeAll(stream, received);
  };
  ScriptedServer server(serve, noWatching);
  Publisher publisher =
      makePublisher(server, {.stream = {}, .session_id = {}, .zstd_level = 0, .in_flight_max = 1});
  publisher.offer(makeFrame(1));
  has_first.get_future().wait();
  for (uint8_t seed = 2; seed <= 5; ++seed) publisher.offer(makeFrame(seed));
  may_report.set_value();
  EXPECT_EQ(publisher.finish(kLong_ns), absl::OkStatus());
  ASSERT_EQ(received.size(), 2U);
  EXPECT_EQ(received[1].header.number(), 5U);
  EXPECT_EQ(received[1].planes[0], bytesOf(makeFrame(5).planes[0]));
  EXPECT_EQ(publisher.counts().replaced_here, 3U);
}

TEST(ClientPublisher, comesBackWithItsSessionAndShowsTheNewestFrameAgain) {
  std::vector<v1::PublishSettings> settings(3);
  std::vector<ReceivedFrame> received;
  const auto serve = [&](PublishStream& stream, int call) {
    if (!accept(stream, &settings[static_cast<size_t>(call)])) return grpc::Status::OK;
    if (call == 2) return takeAll(stream, received);
    readFrame(stream);
    return grpc::Status(grpc::StatusCode::UNAVAILABLE, "drains");
  };
  ScriptedServer server(serve, noWatching);
  Publisher publisher = makePublisher(server);
  publisher.offer(makeFrame(9));
  EXPECT_EQ(publisher.finish(kLong_ns), absl::OkStatus());
  EXPECT_EQ(settings[1].stream(), "s");
  EXPECT_GE(settings[1].session_id().size(), 32U) << "not to be guessed";
  EXPECT_EQ(settings[2].session_id(), settings[1].session_id());
  ASSERT_EQ(received.size(), 1U);
  EXPECT_EQ(received[0].planes[0], bytesOf(makeFrame(9).planes[0]));
  EXPECT_EQ(publisher.counts().reconnects, 1U);
}

TEST(ClientPublisher, survivesARestartOfTheServer) {
  std::promise<void> has_first;
  std::vector<ReceivedFrame> received;
  const auto serve = [&](PublishStream& stream, int call) {
    if (!accept(stream)) return grpc::Status::OK;
    if (call > 1) return takeAll(stream, received);
    const auto first = readFrame(stream);
    report(stream, first->header.number());
    has_first.set_value();
    readFrame(stream);  // until the server goes down
    return grpc::Status(grpc::StatusCode::UNAVAILABLE, "down");
  };
  ScriptedServer server(serve, noWatching);
  std::promise<void> came_back;
  std::atomic<int> connections{0};
  PublisherCallbacks callbacks;
  callbacks.on_accepted = [&](const v1::PublishAccepted&) {
    if (++connections == 2) came_back.set_value();
  };
  // The call breaks off, and the next finds no server.
  std::promise<void> found_none;
  int lost_count = 0;
  callbacks.on_connection = [&](const ConnectionEvent& event) {
    if (event.kind == ConnectionEvent::Kind::kConnected) return;
    if (++lost_count == 2) found_none.set_value();
  };
  Publisher publisher = makePublisher(server, {}, callbacks);
  publisher.offer(makeFrame(1));
  has_first.get_future().wait();
  server.stop();
  found_none.get_future().wait();
  server.start();
  came_back.get_future().wait();
  EXPECT_EQ(publisher.finish(kLong_ns), absl::OkStatus());
  ASSERT_EQ(received.size(), 1U) << "the still is shown again";
  EXPECT_EQ(received[0].planes[0], bytesOf(makeFrame(1).planes[0]));
  EXPECT_EQ(publisher.counts().sent, 1U) << "one frame, shown twice";
  EXPECT_EQ(publisher.counts().reported, 1U);
}

TEST(ClientPublisher, endsWhenTheServerRefusesIt) {
  const auto serve = [](PublishStream&, int) {
    return grpc::Status(grpc::StatusCode::ALREADY_EXISTS, "another publisher");
  };
  ScriptedServer server(serve, noWatching);
  Publisher publisher = makePublisher(server);
  ASSERT_TRUE(publisher.waitEnded(kLong_ns));
  EXPECT_EQ(publisher.ended()->code(), absl::StatusCode::kAlreadyExists);
  EXPECT_EQ(publisher.ended()->message(), "another publisher");
}

TEST(ClientPublisher, canBeDestroyedWhileTheServerDoesNotRead) {
  std::promise<void> is_stalling, client_is_gone;
  const auto serve = [&](PublishStream& stream, int) {
    accept(stream);
    is_stalling.set_value();
    client_is_gone.get_future().wait();
    return grpc::Status::OK;
  };
  ScriptedServer server(serve, noWatching);
  {
    Publisher publisher = makePublisher(server);
    publisher.offer(makeFrame(1));
    is_stalling.get_future().wait();
  }
  client_is_gone.set_value();
}

// Larger than what sockets and windows of HTTP/2 hold, so that a server that does not read stops
// it.
WireFrame makeLargeFrame() {
  WireFrame frame;
  constexpr size_t kLarge_bytes = size_t{64} << 20;
  frame.planes.push_back(std::make_shared<const std::vector<uint8_t>>(kLarge_bytes, uint8_t{7}));
  frame.header.add_sources()->add_layers()->add_planes()->set_bytes_count(kLarge_bytes);
  return frame;
}

// Waits: gRPC may end a call on threads of its own.
bool isLetGo(const std::weak_ptr<const std::vector<uint8_t>>& plane) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::nanoseconds(kLong_ns);
  while (!plane.expired()) {
    if (std::chrono::steady_clock::now() > give_up) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

TEST(ClientPublisher, keepsPlanesUnderWayUntilItIsDestroyedAndNoLonger) {
  std::promise<void> has_header, client_is_gone;
  const auto serve = [&](PublishStream& stream, int) {
    accept(stream);
    v1::PublishFramesRequest request;
    readMessage(stream, request);
    has_header.set_value();
    client_is_gone.get_future().wait();
    return grpc::Status::OK;
  };
  ScriptedServer server(serve, noWatching);
  WireFrame frame = makeLargeFrame();
  const std::weak_ptr<const std::vector<uint8_t>> plane = frame.planes[0];
  {
    Publisher publisher = makePublisher(server);
    publisher.offer(std::move(frame));
    has_header.get_future().wait();
    EXPECT_FALSE(plane.expired());
  }
  client_is_gone.set_value();
  EXPECT_TRUE(isLetGo(plane));
}

TEST(ClientPublisher, letsGoOfPlanesWhoseConnectionIsLost) {
  std::promise<void> has_header;
  const auto serve = [&](PublishStream& stream, int call) {
    std::vector<ReceivedFrame> received;
    if (!accept(stream)) return grpc::Status::OK;
    if (call > 1) return takeAll(stream, received);
    v1::PublishFramesRequest request;
    readMessage(stream, request);
    has_header.set_value();
    while (stream.Read(&request)) {  // until the server goes down
    }
    return grpc::Status(grpc::StatusCode::UNAVAILABLE, "down");
  };
  ScriptedServer server(serve, noWatching);
  Publisher publisher = makePublisher(server);
  WireFrame frame = makeLargeFrame();
  const std::weak_ptr<const std::vector<uint8_t>> plane = frame.planes[0];
  publisher.offer(std::move(frame));
  has_header.get_future().wait();
  publisher.offer(makeFrame(2));  // instead of the frame under way
  server.stop();
  server.start();
  EXPECT_EQ(publisher.finish(kLong_ns), absl::OkStatus());
  EXPECT_TRUE(isLetGo(plane));
}

}  // namespace
}  // namespace viewloom::client_publisher_test
