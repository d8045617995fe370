// SPDX-License-Identifier: Apache-2.0
// Counts of a publisher: frames that the server has taken, however often they were tried.
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <memory>
#include <thread>
#include <vector>

#include "e2e/client/publish_scripts.h"
#include "lib/publisher.h"

namespace viewloom::publisher_counts_test {
namespace {

// A frame that fits the buffers of a connection: it goes whether or not anybody reads it.
WireFrame makeSmallFrame() {
  WireFrame frame;
  frame.planes.push_back(std::make_shared<const std::vector<uint8_t>>(10, uint8_t{7}));
  frame.header.add_sources()->add_layers()->add_planes()->set_bytes_count(10);
  return frame;
}

TEST(PublisherCounts, countsAFrameOnceHoweverOftenItIsTried) {
  std::vector<ReceivedFrame> received;
  const auto serve = [&](PublishStream& stream, int call) {
    if (!accept(stream)) return grpc::Status::OK;
    if (call > 3) return takeAll(stream, received);
    readFrame(stream);
    return grpc::Status(grpc::StatusCode::UNAVAILABLE, "drains");
  };
  ScriptedServer server(serve, noWatching);
  Publisher publisher = makePublisher(server);
  publisher.offer(makeSmallFrame());
  EXPECT_EQ(publisher.finish(kLong_ns), absl::OkStatus());
  EXPECT_EQ(publisher.counts().sent, 1U);
  EXPECT_EQ(publisher.counts().sent_bytes, 10U);
}

TEST(PublisherCounts, countsNothingWhileItIsNotAccepted) {
  std::promise<void> has_waited;
  const auto serve = [&](PublishStream& stream, int call) {
    v1::PublishFramesRequest request;
    stream.Read(&request);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));  // a frame would come meanwhile
    if (call == 3) has_waited.set_value();
    return grpc::Status(grpc::StatusCode::UNAVAILABLE, "not now");
  };
  ScriptedServer server(serve, noWatching);
  Publisher publisher = makePublisher(server);
  publisher.offer(makeSmallFrame());
  has_waited.get_future().wait();
  EXPECT_EQ(publisher.counts().sent, 0U);
  EXPECT_EQ(publisher.counts().sent_bytes, 0U);
  EXPECT_TRUE(publisher.isWaiting()) << "a newer frame may still replace it";
}

TEST(PublisherCounts, countsRefusedFramesApart) {
  const auto serve = [&](PublishStream& stream, int) {
    if (!accept(stream)) return grpc::Status::OK;
    for (const auto outcome : {v1::FRAME_OUTCOME_REFUSED, v1::FRAME_OUTCOME_REPLACED}) {
      if (const auto frame = readFrame(stream)) report(stream, frame->header.number(), outcome);
    }
    readFrame(stream);  // until the client ends
    return grpc::Status::OK;
  };
  ScriptedServer server(serve, noWatching);
  std::promise<void> is_refused;
  PublisherCallbacks callbacks;
  callbacks.on_report = [&](const v1::FrameReport& frame) {
    if (frame.number() == 1) is_refused.set_value();
  };
  Publisher publisher = makePublisher(server, {}, callbacks);
  publisher.offer(makeSmallFrame());
  is_refused.get_future().wait();
  EXPECT_EQ(publisher.counts().sent, 0U);
  publisher.offer(makeSmallFrame());
  EXPECT_EQ(publisher.finish(kLong_ns), absl::OkStatus());
  EXPECT_EQ(publisher.counts().refused, 1U);
  EXPECT_EQ(publisher.counts().sent, 1U);
  EXPECT_EQ(publisher.counts().replaced_there, 1U);
  EXPECT_EQ(publisher.counts().reported, 2U);
}

}  // namespace
}  // namespace viewloom::publisher_counts_test
