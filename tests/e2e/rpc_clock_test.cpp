// SPDX-License-Identifier: Apache-2.0
// Clock probes in the call that also carries atlases.
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <vector>

#include <grpcpp/client_context.h>

#include "base/clock.h"
#include "e2e/bystander.h"
#include "viewloom/v1/display_service.grpc.pb.h"

namespace viewloom::rpc_clock_test {
namespace {

constexpr uint32_t kWide_px = 4096;
constexpr uint32_t kHigh_px = 2048;
constexpr uint32_t kAtlas_bytes = 3 * kWide_px * kHigh_px;

// A call as it is on the wire. Ends after a minute at the latest.
class Call {
 public:
  Call(const TestServer& server, const v1::OpenDisplay& open)
      : stub_(v1::DisplayService::NewStub(server.connect())) {
    context_.set_deadline(std::chrono::system_clock::now() + std::chrono::minutes(1));
    call_ = stub_->StreamAtlases(&context_);
    v1::StreamAtlasesRequest request;
    *request.mutable_open() = open;
    EXPECT_TRUE(call_->Write(request));
  }
  ~Call() {
    context_.TryCancel();
    call_->Finish();
  }

  void probe(int64_t client_time_ns) {
    v1::StreamAtlasesRequest request;
    request.mutable_clock_probe()->set_client_time_ns(client_time_ns);
    EXPECT_TRUE(call_->Write(request));
  }
  v1::StreamAtlasesResponse read() {
    v1::StreamAtlasesResponse response;
    EXPECT_TRUE(call_->Read(&response));
    return response;
  }

 private:
  const std::unique_ptr<v1::DisplayService::Stub> stub_;
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReaderWriter<v1::StreamAtlasesRequest, v1::StreamAtlasesResponse>>
      call_;
};

v1::OpenDisplay largeQuilt() {
  v1::OpenDisplay open = smallQuilt("healthy");
  open.mutable_display()->mutable_quilt()->mutable_size()->set_width(kWide_px);
  open.mutable_display()->mutable_quilt()->mutable_size()->set_height(kHigh_px);
  return open;
}

TEST(ClockProbe, isAnsweredWithTheServersMonotonicTime) {
  TestServer server;
  const SteadyClock clock;
  v1::OpenDisplay open = smallQuilt("later");
  open.set_wait_for_stream(true);  // there is nothing to show
  Call call(server, open);
  for (const int64_t client_time_ns : {int64_t{-5}, int64_t{0}, INT64_MAX}) {
    const int64_t before_ns = clock.nowNs();
    call.probe(client_time_ns);
    const v1::StreamAtlasesResponse response = call.read();
    ASSERT_TRUE(response.has_clock_reply());
    EXPECT_EQ(response.clock_reply().client_time_ns(), client_time_ns);
    EXPECT_GE(response.clock_reply().server_received_ns(), before_ns);
    EXPECT_GE(response.clock_reply().server_sent_ns(), response.clock_reply().server_received_ns());
    EXPECT_LE(response.clock_reply().server_sent_ns(), clock.nowNs());
  }
}

TEST(ClockProbe, isAnsweredBeforeAnAtlasIsThrough) {
  TestServer server;
  Bystander bystander(server);
  bystander.expectUndisturbed();
  Call call(server, largeQuilt());
  ASSERT_TRUE(call.read().has_layout());
  ASSERT_TRUE(call.read().has_header());
  // The first pieces are on their way, and wait to be read; the others are written behind the
  // answer.
  call.probe(3);
  uint32_t bytes_before = 0;
  uint32_t bytes_after = 0;
  bool is_answered = false;
  while (true) {
    const v1::StreamAtlasesResponse response = call.read();
    if (response.has_end()) break;
    if (response.has_clock_reply()) is_answered = true;
    (is_answered ? bytes_after : bytes_before) += uint32_t(response.band().data().size());
  }
  EXPECT_TRUE(is_answered);
  EXPECT_GT(bytes_after, 0u) << "came behind " << bytes_before << " bytes";
  EXPECT_EQ(bytes_before + bytes_after, kAtlas_bytes) << "the atlas is whole";
}

TEST(ClockProbe, leavesAtlasesThroughHoweverOftenItComes) {
  TestServer server;
  Bystander bystander(server);
  bystander.expectUndisturbed();
  Call call(server, largeQuilt());
  constexpr int kProbeCount = 2000;
  for (int i = 1; i <= kProbeCount; ++i) call.probe(i);
  uint32_t atlas_bytes = 0;
  std::vector<int64_t> answered;
  bool is_whole = false;
  while (!is_whole || answered.empty() || answered.back() < kProbeCount) {
    const v1::StreamAtlasesResponse response = call.read();
    is_whole |= response.has_end();
    atlas_bytes += uint32_t(response.band().data().size());
    if (!response.has_clock_reply()) continue;
    const int64_t newest = response.clock_reply().client_time_ns();
    EXPECT_GT(newest, answered.empty() ? 0 : answered.back());
    answered.push_back(newest);
  }
  EXPECT_EQ(atlas_bytes, kAtlas_bytes);
  bystander.expectUndisturbed();
}

}  // namespace
}  // namespace viewloom::rpc_clock_test
