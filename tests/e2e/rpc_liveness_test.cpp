// SPDX-License-Identifier: Apache-2.0
// Heartbeats: who sends them keeps a name, who stops loses it, and standing streams are heard of.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "e2e/test_publisher.h"
#include "e2e/test_server.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "viewloom/v1/display_service.grpc.pb.h"

namespace viewloom::rpc_liveness_test {
namespace {

using testing::HasSubstr;

v1::PublishFramesRequest settings(const std::string& session_id) {
  v1::PublishFramesRequest request;
  request.mutable_settings()->set_stream("s");
  request.mutable_settings()->set_session_id(session_id);
  request.mutable_settings()->set_sends_heartbeats(true);
  return request;
}

v1::PublishFramesRequest heartbeat() {
  v1::PublishFramesRequest request;
  request.mutable_heartbeat();
  return request;
}

bool isLive(const TestServer& server) {
  return server.directory().list().front().live;
}

TEST(Liveness, aPublisherThatFallsSilentLosesItsName) {
  TestServer server;
  TestPublisher silent(server.connect());
  silent.send(settings("one"));
  ASSERT_TRUE(silent.read()->has_accepted());
  ASSERT_TRUE(isLive(server));
  const grpc::Status end = silent.finish();  // waits for the server
  EXPECT_EQ(end.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_THAT(end.error_message(), HasSubstr("no heartbeat came for 5 s"));
  EXPECT_FALSE(isLive(server));
  TestPublisher next(server.connect(), "s", "two");
  EXPECT_TRUE(isLive(server));
}

TEST(Liveness, aPublisherThatSendsHeartbeatsKeepsItsNameAndHearsTheServer) {
  TestServer server;
  TestPublisher publisher(server.connect());
  publisher.send(settings("one"));
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(7);
  std::jthread beats([&] {
    while (std::chrono::steady_clock::now() < until) {
      publisher.send(heartbeat());
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
    }
    publisher.halfClose();
  });
  int heard_count = 0;
  while (const auto response = publisher.read()) heard_count += response->has_heartbeat();
  beats.join();
  EXPECT_TRUE(publisher.finish().ok()) << "it ended by itself";
  EXPECT_GE(heard_count, 3);
}

TEST(Liveness, aPublisherThatAnnouncesNoHeartbeatsMayBeSilentAndGetsNone) {
  TestServer server;
  TestPublisher publisher(server.connect(), "s", "one");
  std::this_thread::sleep_for(std::chrono::seconds(6));
  EXPECT_TRUE(isLive(server));
  publisher.halfClose();
  while (const auto response = publisher.read()) EXPECT_FALSE(response->has_heartbeat());
  EXPECT_TRUE(publisher.finish().ok());
}

TEST(Liveness, aSecondPublisherOfTheHostIsToldToAskAgain) {
  TestServer server;
  TestPublisher first(server.connect(), "s", "one");
  TestPublisher second(server.connect());
  second.sendSettings("s", "two");
  const grpc::Status refused = second.finish();
  EXPECT_EQ(refused.error_code(), grpc::StatusCode::ALREADY_EXISTS);
  EXPECT_THAT(refused.error_message(), HasSubstr("on this machine, for 0 s"));
  google::rpc::Status details;
  google::rpc::RetryInfo retry;
  ASSERT_TRUE(details.ParseFromString(refused.error_details()));
  ASSERT_GT(details.details_size(), 0);
  ASSERT_TRUE(details.details(details.details_size() - 1).UnpackTo(&retry));
  EXPECT_GT(retry.retry_delay().seconds(), 0);
}

// Reads until the server has sent so many heartbeats; other messages are counted as atlases'.
struct Heard {
  int heartbeat_count = 0;
  int other_count = 0;
};
Heard watchStandingStream(const TestServer& server, bool wants_heartbeats, int heartbeat_count) {
  const auto stub = v1::DisplayService::NewStub(server.connect());
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() +
                       std::chrono::seconds(heartbeat_count > 0 ? 60 : 3));
  const auto call = stub->StreamAtlases(&context);
  v1::StreamAtlasesRequest request;
  v1::OpenDisplay& open = *request.mutable_open();
  open.set_stream("nothere");
  open.set_wait_for_stream(true);
  open.set_wants_heartbeats(wants_heartbeats);
  v1::QuiltDisplay& quilt = *open.mutable_display()->mutable_quilt();
  quilt.set_columns(2);
  quilt.set_rows(1);
  quilt.mutable_size()->set_width(8);
  quilt.mutable_size()->set_height(4);
  call->Write(request);
  Heard heard;
  v1::StreamAtlasesResponse response;
  while ((heartbeat_count == 0 || heard.heartbeat_count < heartbeat_count) &&
         call->Read(&response)) {
    ++(response.has_heartbeat() ? heard.heartbeat_count : heard.other_count);
  }
  context.TryCancel();
  while (call->Read(&response)) {
  }
  call->Finish();
  return heard;
}

TEST(Liveness, aViewerHearsOfAServerWhoseStreamStands) {
  TestServer server;
  const Heard heard = watchStandingStream(server, true, 3);
  EXPECT_EQ(heard.heartbeat_count, 3);
  EXPECT_EQ(heard.other_count, 0);
}

TEST(Liveness, aViewerThatDoesNotAskHearsNone) {
  TestServer server;
  EXPECT_EQ(watchStandingStream(server, false, 0).heartbeat_count, 0);
}

}  // namespace
}  // namespace viewloom::rpc_liveness_test
