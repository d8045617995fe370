// SPDX-License-Identifier: Apache-2.0
// Promises to publishers.
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <set>
#include <string>
#include <thread>

#include "e2e/bystander.h"
#include "e2e/raw_call.h"
#include "e2e/refusal.h"

namespace viewloom::rpc_publish_test {
namespace {

StreamEntry entryOf(const TestServer& server, const std::string& stream) {
  for (const StreamEntry& entry : server.directory().list()) {
    if (entry.name == stream) return entry;
  }
  return {};
}

TEST(PublishFrames, saysWhatItAccepts) {
  TestServer server;
  TestPublisher publisher(server.connect());
  publisher.sendSettings("scene");
  const auto response = publisher.read();
  ASSERT_TRUE(response.has_value() && response->has_accepted());
  EXPECT_EQ(response->accepted().plane_side_px_max(), 8192u);
  EXPECT_EQ(response->accepted().layer_count_max(), 4u);
  EXPECT_EQ(response->accepted().frame_bytes_max(), uint64_t{3} << 29);
}

TEST(PublishFrames, reportsEveryFrameExactlyOnce) {
  TestServer server;
  TestPublisher publisher(server.connect(), "scene");
  constexpr uint64_t kFrameCount = 300;  // more than may be without a report at a time
  for (uint64_t number = 1; number <= kFrameCount; ++number) {
    ASSERT_TRUE(publisher.sendFrame(number * 2));  // numbers may have gaps
  }
  publisher.halfClose();
  std::map<uint64_t, int> report_counts;
  while (const auto report = publisher.readReport()) ++report_counts[report->number()];
  EXPECT_TRUE(publisher.finish().ok());
  EXPECT_EQ(report_counts.size(), kFrameCount);
  for (const auto& [number, count] : report_counts) EXPECT_EQ(count, 1) << "frame " << number;
  const StreamEntry entry = entryOf(server, "scene");
  EXPECT_EQ(entry.received_count, kFrameCount);
  EXPECT_EQ(entry.refused_count, 0u);
  EXPECT_EQ(entry.used_count + entry.replaced_count, kFrameCount);
}

// A connection that keeps 64 KiB of what its client has not read, as HTTP/2 starts with, and no
// more.
std::shared_ptr<grpc::Channel> connectWithFixedWindow(const TestServer& server) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  return grpc::CreateCustomChannel(server.address(), grpc::InsecureChannelCredentials(), arguments);
}

TEST(PublishFrames, holdsBackAPublisherThatDoesNotReadItsReportsAndNobodyElse) {
  TestServer server;
  Bystander bystander(server);
  TestPublisher publisher(connectWithFixedWindow(server), "deaf");
  constexpr uint64_t kFrameCount = 20'000;
  std::jthread writer([&] {
    for (uint64_t number = 1; number <= kFrameCount && publisher.sendFrame(number); ++number) {
    }
    publisher.halfClose();
  });
  const auto received = [&] { return entryOf(server, "deaf").received_count; };
  constexpr std::chrono::milliseconds kStandstill(500);
  for (uint64_t before = kFrameCount; before != received();) {
    before = received();
    std::this_thread::sleep_for(kStandstill);
  }
  const uint64_t held_at = received();
  EXPECT_LT(held_at, kFrameCount) << "the server reads on";
  bystander.expectUndisturbed();
  EXPECT_EQ(received(), held_at);

  std::map<uint64_t, int> report_counts;
  while (const auto report = publisher.readReport()) ++report_counts[report->number()];
  EXPECT_TRUE(publisher.finish().ok()) << "once it reads it is served as any other";
  EXPECT_EQ(report_counts.size(), kFrameCount);
  for (const auto& [number, count] : report_counts) ASSERT_EQ(count, 1) << "frame " << number;
  EXPECT_EQ(received(), kFrameCount);
}

TEST(PublishFrames, reportsWhatANewerFrameReplaced) {
  TestServer server;
  server.sink().hold("scene");
  TestPublisher publisher(server.connect(), "scene");
  for (uint64_t number = 1; number <= 3; ++number) publisher.sendFrame(number);
  std::set<uint64_t> replaced;  // which of two threads reports first is open
  for (int i = 0; i < 2; ++i) {
    const auto report = publisher.readReport();
    ASSERT_TRUE(report.has_value());
    EXPECT_EQ(report->outcome(), v1::FRAME_OUTCOME_REPLACED);
    replaced.insert(report->number());
  }
  EXPECT_EQ(replaced, (std::set<uint64_t>{1, 2}));
  server.sink().letGo("scene");
  const auto report = publisher.readReport();
  ASSERT_TRUE(report.has_value());
  EXPECT_EQ(report->number(), 3u);
  EXPECT_EQ(report->outcome(), v1::FRAME_OUTCOME_BUILT_WITHOUT_DISPLAY);
  EXPECT_EQ(report->stats().depth_step(), 0.5);
  EXPECT_EQ(entryOf(server, "scene").replaced_count, 2u);
}

TEST(PublishFrames, reportsToEachFrameTheDisplaysItWasTracedFor) {
  TestServer server;
  TestPublisher publisher(server.connect(), "scene");
  publisher.sendFrame(1);
  TestWatcher watcher(server.connect(), smallQuilt("scene"));
  ASSERT_TRUE(watcher.readAtlas().has_value());
  publisher.readReport();
  publisher.sendFrame(2);
  const auto report = publisher.readReport();
  ASSERT_TRUE(report.has_value());
  ASSERT_EQ(report->displays_size(), 1);
  EXPECT_EQ(report->displays(0).display_id(), server.broadcaster().displays("scene")[0]->id);
  EXPECT_EQ(report->displays(0).coverage().hit(), 0.75);
}

TEST(PublishFrames, handsTheStreamToWhoeverShowsItsSecret) {
  TestServer server;
  Bystander bystander(server);
  server.sink().hold("scene");
  TestPublisher old_one(server.connect(), "scene", "secret");
  old_one.sendFrame(8);
  old_one.sendFrame(9);
  ASSERT_EQ(old_one.readReport()->number(), 8u);  // replaced by 9, so 9 was taken
  TestPublisher new_one(server.connect(), "scene", "secret");
  server.sink().letGo("scene");
  const auto report = old_one.readReport();
  ASSERT_TRUE(report.has_value()) << "frames taken before are reported";
  EXPECT_EQ(report->number(), 9u);
  EXPECT_EQ(old_one.finish().error_code(), grpc::StatusCode::ABORTED);
  ASSERT_TRUE(new_one.sendFrame(1));
  EXPECT_EQ(new_one.readReport()->number(), 1u);
  bystander.expectUndisturbed();
}

TEST(PublishFrames, freesTheNameOfAPublisherThatVanished) {
  TestServer server;
  {
    TestPublisher vanishing(server.connect(), "scene");
    vanishing.sendHeader(smallHeader(1));
    vanishing.cancel();
  }
  // Until the server has heard of it, the name is taken.
  for (;;) {
    TestPublisher next(server.connect());
    next.sendSettings("scene");
    if (next.read().has_value()) break;
    ASSERT_EQ(next.finish().error_code(), grpc::StatusCode::ALREADY_EXISTS);
  }
}

TEST(PublishFrames, tellsWhatItsDisplaysWant) {
  TestServer server;
  TestPublisher publisher(server.connect(), "scene");
  EXPECT_EQ(publisher.readWanted()->display_count(), 0u);
  publisher.sendFrame(1);
  ASSERT_TRUE(publisher.readReport().has_value());
  v1::OpenDisplay open = smallQuilt("scene");
  v1::CamerasDisplay& cameras = *open.mutable_display()->mutable_cameras();
  *cameras.add_cameras() = smallHeader(1).sources(0).camera();
  cameras.mutable_tile_size()->set_width(20);
  cameras.mutable_tile_size()->set_height(10);
  TestWatcher watcher(server.connect(), open);
  std::optional<v1::Wanted> wanted = publisher.readWanted();
  ASSERT_TRUE(wanted.has_value());
  EXPECT_EQ(wanted->display_count(), 1u);
  // One view that is the source: a source of the tile's size and its own angles loses nothing.
  EXPECT_EQ(wanted->size().width(), 20u);
  EXPECT_EQ(wanted->size().height(), 10u);
  EXPECT_DOUBLE_EQ(wanted->fov().angle_left_rad(), -0.5);
  EXPECT_DOUBLE_EQ(wanted->fov().angle_right_rad(), 0.5);
  EXPECT_DOUBLE_EQ(wanted->fov().angle_up_rad(), 0.4);
  EXPECT_DOUBLE_EQ(wanted->fov().angle_down_rad(), -0.4);
  EXPECT_EQ(wanted->layer_count(), 1u);
  ASSERT_TRUE(watcher.readAtlas().has_value());
  watcher.cancel();
  EXPECT_EQ(publisher.readWanted()->display_count(), 0u);
}

TEST(PublishFrames, refusesBytesThatAreNoMessage) {
  TestServer server;
  Bystander bystander(server);
  for (const std::string& bytes : {std::string("\xff\xff\xff", 3), std::string(4000, '\x1a')}) {
    const RawReply reply =
        converse(server.connect(), "/viewloom.v1.IngestService/PublishFrames", bytes);
    EXPECT_EQ(reply.status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    EXPECT_TRUE(reply.messages.empty());
    bystander.expectUndisturbed();
  }
}

}  // namespace
}  // namespace viewloom::rpc_publish_test
