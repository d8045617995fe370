// SPDX-License-Identifier: Apache-2.0
// Messages of a client that do not follow on, and one client too many.
#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "e2e/bystander.h"
#include "e2e/refusal.h"

namespace viewloom::rpc_bad_watchers_test {
namespace {

constexpr auto kInvalid = grpc::StatusCode::INVALID_ARGUMENT;
constexpr auto kTooMany = grpc::StatusCode::RESOURCE_EXHAUSTED;

struct BadConversation {
  const char* name;
  std::function<void(TestWatcher&)> send;
  Refusal refusal;
};

v1::StreamAtlasesRequest opening() {
  v1::StreamAtlasesRequest request;
  *request.mutable_open() = smallQuilt("healthy");
  return request;
}

TEST(StreamAtlases, refusesMessagesThatDoNotFollowOn) {
  const std::vector<BadConversation> cases = {
      {"nothing at all", [](auto& w) { w.halfClose(); }, {kInvalid, "open"}},
      {"an empty message", [](auto& w) { w.send({}); }, {kInvalid, "message"}},
      {"change first",
       [](auto& w) {
         v1::StreamAtlasesRequest request;
         request.mutable_change();
         w.send(request);
       },
       {kInvalid, "message"}},
      {"asking for the time first",
       [](auto& w) {
         v1::StreamAtlasesRequest request;
         request.mutable_clock_probe();
         w.send(request);
       },
       {kInvalid, "message"}},
      {"open twice",
       [](auto& w) {
         w.send(opening());
         w.send(opening());
       },
       {kInvalid, "open"}},
      {"a bad change",
       [](auto& w) {
         w.send(opening());
         v1::StreamAtlasesRequest request;
         request.mutable_change()->mutable_display()->mutable_quilt();
         w.send(request);
       },
       {kInvalid, "change.display.quilt.columns"}},
      {"a bad new encoding",
       [](auto& w) {
         w.send(opening());
         v1::StreamAtlasesRequest request;
         request.mutable_change()->mutable_encoding()->set_jpeg_quality(1000);
         w.send(request);
       },
       {kInvalid, "change.encoding.jpeg_quality"}},
  };
  TestServer server;
  Bystander bystander(server);
  for (const BadConversation& bad : cases) {
    SCOPED_TRACE(bad.name);
    TestWatcher watcher(server.connect());
    bad.send(watcher);
    EXPECT_EQ(refusalOf(watcher.finish()), bad.refusal);
    bystander.expectUndisturbed();
  }
}

TEST(StreamAtlases, refusesMoreDisplaysAndSubscribersThanItTakes) {
  TestServer server({.display_count_max = 1, .subscriber_count_max = 2});
  Bystander bystander(server);
  bystander.expectUndisturbed();
  v1::OpenDisplay other = smallQuilt("healthy");
  other.mutable_display()->mutable_quilt()->set_view_count(1);
  TestWatcher second_display(server.connect(), other);
  EXPECT_EQ(second_display.finish().error_code(), kTooMany);
  TestWatcher second_subscriber(server.connect(), smallQuilt("healthy"));
  ASSERT_TRUE(second_subscriber.readAtlas().has_value());
  TestWatcher third_subscriber(server.connect(), smallQuilt("healthy"));
  EXPECT_EQ(third_subscriber.finish().error_code(), kTooMany);
  bystander.expectUndisturbed();
}

TEST(StreamAtlases, endsWhenTheDisplayFitsNoCameraOfTheStream) {
  TestServer server;
  Bystander bystander(server);
  v1::OpenDisplay other = smallQuilt("healthy");
  other.mutable_display()->mutable_quilt()->set_view_count(1);
  TestWatcher watcher(server.connect(), other);
  ASSERT_TRUE(watcher.readAtlas().has_value());
  const ActiveDisplayPtr display = server.broadcaster().displays("healthy").back();
  server.broadcaster().refuse(
      display->id, fieldError(absl::StatusCode::kFailedPrecondition, "quilt.size", "does not fit"));
  EXPECT_EQ(refusalOf(watcher.finish()),
            (Refusal{grpc::StatusCode::FAILED_PRECONDITION, "open.display.quilt.size"}));
  bystander.expectUndisturbed();
}

}  // namespace
}  // namespace viewloom::rpc_bad_watchers_test
