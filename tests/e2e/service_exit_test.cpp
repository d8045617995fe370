// SPDX-License-Identifier: Apache-2.0
// How viewloomd starts and ends as a process.
#include <gmock/gmock.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <future>
#include <string>
#include <vector>

#include "e2e/server_process.h"
#include "e2e/wire_frames.h"
#include "lib/atlas_assembler.h"
#include "lib/channel.h"
#include "lib/publisher.h"
#include "support/test_device.h"
#include "viewloom/v1/display_service.grpc.pb.h"

namespace viewloom::test::service_exit_test {
namespace {

const std::vector<std::string> kAnyPorts{"--grpc.address", "127.0.0.1:0", "--http.address",
                                         "127.0.0.1:0"};
constexpr SizePx kFramePx{160, 90};
// Longer than a report that was sent needs to arrive.
constexpr std::chrono::seconds kReportTime{10};

using ViewloomdProcess = DeviceNeededTest;

// Offers frame after frame until it is told to stop.
class EndlessPublisher {
 public:
  explicit EndlessPublisher(const std::string& address)
      : publisher_(makeChannel(address), {.stream = "scene", .session_id = "", .backoff = {}},
                   {.on_accepted = {},
                    .on_report = [this](const v1::FrameReport&) { offer(); },
                    .on_wanted = {},
                    .on_connection = {}}) {
    offer();
    offer();
  }

 private:
  void offer() { publisher_.offer(frames_[offered_count_++ % frames_.size()]); }

  // Two by turns: of one alone that is offered again nothing would be made.
  const std::array<WireFrame, 2> frames_ = {syntheticWireFrame(kFramePx, 2, 0),
                                            syntheticWireFrame(kFramePx, 2, 1)};
  std::atomic<size_t> offered_count_ = 0;
  Publisher publisher_;
};

TEST_F(ViewloomdProcess, givesWholeAtlasesOnlyAndExitsWithZeroWhenTerminatedInMidStream) {
  ServerProcess server(kAnyPorts);
  ASSERT_FALSE(server.grpcAddress().empty());
  EndlessPublisher publisher(server.grpcAddress());

  const auto stub = v1::DisplayService::NewStub(makeChannel(server.grpcAddress()));
  grpc::ClientContext context;
  const auto call = stub->StreamAtlases(&context);
  v1::StreamAtlasesRequest request;
  *request.mutable_open() = openQuilt("scene", {400, 300});
  ASSERT_TRUE(call->Write(request));
  call->WritesDone();

  AtlasAssembler assembler;
  uint64_t atlas_count = 0;
  v1::StreamAtlasesResponse message;
  while (call->Read(&message)) {
    // In the middle of the third atlas: after its header, before its end.
    if (atlas_count == 2 && message.has_header()) server.sendSignal(SIGTERM);
    const auto atlas = assembler.add(std::move(message));
    ASSERT_TRUE(atlas.ok()) << atlas.status();
    if (atlas->has_value()) {
      ++atlas_count;
      EXPECT_TRUE(hasWholePlane(**atlas, v1::ATLAS_PLANE_COLOR));
    }
  }
  const grpc::Status end = call->Finish();
  EXPECT_TRUE(end.ok()) << end.error_code() << " " << end.error_message();
  assembler.restart();
  EXPECT_EQ(assembler.counts().discarded, 0u);
  EXPECT_GE(atlas_count, 3u);
  EXPECT_EQ(server.waitForExit(), 0);
}

TEST_F(ViewloomdProcess, cancelsAReceiverThatDoesNotReadAndExitsWithZero) {
  ServerProcess server(kAnyPorts);
  ASSERT_FALSE(server.grpcAddress().empty());
  EndlessPublisher publisher(server.grpcAddress());

  const auto stub = v1::DisplayService::NewStub(makeChannel(server.grpcAddress()));
  grpc::ClientContext context;
  const auto call = stub->StreamAtlases(&context);
  v1::StreamAtlasesRequest request;
  *request.mutable_open() = openQuilt("scene", {800, 600});
  // Raw bands, so that the first atlas alone overfills what gRPC buffers.
  request.mutable_open()->mutable_encoding()->set_color(v1::BAND_ENCODING_RAW);
  ASSERT_TRUE(call->Write(request));
  v1::StreamAtlasesResponse layout;
  ASSERT_TRUE(call->Read(&layout));

  server.sendSignal(SIGTERM);
  EXPECT_EQ(server.waitForExit(), 0);
  context.TryCancel();
  while (call->Read(&layout)) {
  }
  EXPECT_FALSE(call->Finish().ok());
}

// The environment of a server whose Vulkan fails: a function, which of its calls, and the VkResult.
std::vector<std::string> withFault(const std::string& fault) {
  return {"VK_LAYER_PATH=" VIEWLOOM_LAYER_FOLDER, "VK_INSTANCE_LAYERS=VK_LAYER_VIEWLOOM_fault",
          "VIEWLOOM_FAULT=" + fault};
}

constexpr const char* kDeviceLost = " -4";

// The number of the submission at which the device is lost: the build of the first frame, the first
// strip of its atlas, the next.
class ViewloomdOnALostDevice : public DeviceNeededTest, public testing::WithParamInterface<int> {};

TEST_P(ViewloomdOnALostDevice, saysWhyEndsItsCallsAndExitsWithThree) {
  testing::internal::CaptureStderr();
  ServerProcess server(kAnyPorts,
                       withFault("vkQueueSubmit2 " + std::to_string(GetParam()) + kDeviceLost));
  const auto stub = v1::DisplayService::NewStub(makeChannel(server.grpcAddress()));
  grpc::ClientContext context;
  const auto call = stub->StreamAtlases(&context);
  v1::StreamAtlasesRequest request;
  *request.mutable_open() = openQuilt("scene", {400, 300});
  request.mutable_open()->set_wait_for_stream(true);
  // Above the source: the device has to build and to walk.
  v1::Pose& pose = *request.mutable_open()->mutable_display()->mutable_world_pose();
  pose.mutable_position()->set_y(0.05);
  pose.mutable_orientation()->set_w(1);
  EXPECT_TRUE(call->Write(request));
  call->WritesDone();

  std::promise<v1::FrameReport> report;
  Publisher publisher(makeChannel(server.grpcAddress()),
                      {.stream = "scene", .session_id = "", .backoff = {}},
                      {.on_accepted = {},
                       .on_report = [&](const v1::FrameReport& first) { report.set_value(first); },
                       .on_wanted = {},
                       .on_connection = {}});
  publisher.offer(syntheticWireFrame(kFramePx, 2, 0));
  v1::StreamAtlasesResponse message;
  // Bands that were packed before the loss may have left. The atlas must not end.
  while (call->Read(&message)) EXPECT_FALSE(message.has_end());
  const grpc::Status end = call->Finish();
  EXPECT_TRUE(end.ok()) << end.error_code() << " " << end.error_message();
  const int exit_code = server.waitForExit();
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_EQ(exit_code, 3) << log;
  EXPECT_THAT(log, testing::HasSubstr("ErrorDeviceLost"));
  std::future<v1::FrameReport> arrived = report.get_future();
  ASSERT_EQ(arrived.wait_for(kReportTime), std::future_status::ready);
  EXPECT_NE(arrived.get().outcome(), v1::FRAME_OUTCOME_TRACED);
}

INSTANTIATE_TEST_SUITE_P(Submissions, ViewloomdOnALostDevice, testing::Values(1, 2, 3));

TEST_F(ViewloomdProcess, exitsWithThreeWhenItsDeviceIsLostAtTheStart) {
  ServerProcess server(kAnyPorts, withFault(std::string("vkCreateDevice 1") + kDeviceLost));
  EXPECT_TRUE(server.grpcAddress().empty());
  EXPECT_EQ(server.waitForExit(), 3);
}

TEST_F(ViewloomdProcess, exitsWithTwoOnASettingThatDoesNotExist) {
  ServerProcess server({"--no.such.setting", "1"});
  EXPECT_TRUE(server.grpcAddress().empty());
  EXPECT_EQ(server.waitForExit(), 2);
}

TEST_F(ViewloomdProcess, exitsWithTwoWhenItsPortIsTaken) {
  const ServerProcess first(kAnyPorts);
  ASSERT_FALSE(first.grpcAddress().empty());
  ServerProcess second({"--grpc.address", first.grpcAddress(), "--http.address", "127.0.0.1:0"});
  EXPECT_TRUE(second.grpcAddress().empty());
  EXPECT_EQ(second.waitForExit(), 2);
}

TEST_F(ViewloomdProcess, exitsWithTwoWhenTheDeviceDoesNotExist) {
  ServerProcess server({"--device", "no such device"});
  EXPECT_TRUE(server.grpcAddress().empty());
  EXPECT_EQ(server.waitForExit(), 2);
}

}  // namespace
}  // namespace viewloom::test::service_exit_test
