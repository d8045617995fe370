// SPDX-License-Identifier: Apache-2.0
// The server around its services: catalogue, health, reflection, port.
#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "e2e/raw_call.h"
#include "e2e/test_publisher.h"
#include "e2e/test_server.h"
#include "e2e/test_watcher.h"
#include "grpc/health/v1/health.grpc.pb.h"

namespace viewloom::rpc_server_test {
namespace {

namespace health = grpc::health::v1;

TEST(CatalogService, listsStreamsAndDisplays) {
  TestServer server;
  TestPublisher publisher(server.connect(), "scene");
  publisher.sendFrame(3);
  TestWatcher watcher(server.connect(), smallQuilt("scene"));
  ASSERT_TRUE(watcher.readAtlas().has_value());
  const auto stub = v1::CatalogService::NewStub(server.connect());

  grpc::ClientContext streams_context;
  v1::ListStreamsResponse streams;
  ASSERT_TRUE(stub->ListStreams(&streams_context, {}, &streams).ok());
  ASSERT_EQ(streams.streams_size(), 1);
  EXPECT_EQ(streams.streams(0).name(), "scene");
  EXPECT_TRUE(streams.streams(0).live());
  EXPECT_EQ(streams.streams(0).frame_number(), 3u);
  EXPECT_EQ(streams.streams(0).size().width(), 4u);
  EXPECT_EQ(streams.streams(0).layer_count(), 1u);
  EXPECT_EQ(streams.streams(0).received_count(), 1u);
  EXPECT_EQ(streams.streams(0).subscriber_count(), 1u);
  EXPECT_EQ(streams.streams(0).stats().depth_step(), 0.5);

  grpc::ClientContext displays_context;
  v1::ListDisplaysResponse displays;
  ASSERT_TRUE(stub->ListDisplays(&displays_context, {}, &displays).ok());
  ASSERT_EQ(displays.displays_size(), 1);
  EXPECT_EQ(displays.displays(0).stream(), "scene");
  EXPECT_EQ(displays.displays(0).layout().columns(), 2u);
  EXPECT_EQ(displays.displays(0).layout().views_size(), 2);
  EXPECT_EQ(displays.displays(0).subscriber_count(), 1u);
  EXPECT_EQ(displays.displays(0).atlas_count(), 1u);
}

TEST(CatalogService, tellsTheLayoutOfADisplayThatWaitsForItsFirstAtlas) {
  TestServer server;
  TestPublisher publisher(server.connect(), "scene");
  TestWatcher watcher(server.connect(), smallQuilt("scene"));
  const auto stub = v1::CatalogService::NewStub(server.connect());
  const auto list = [&] {
    grpc::ClientContext context;
    v1::ListDisplaysResponse displays;
    EXPECT_TRUE(stub->ListDisplays(&context, {}, &displays).ok());
    return displays;
  };
  v1::ListDisplaysResponse displays = list();
  for (; displays.displays_size() == 0; displays = list()) std::this_thread::yield();
  EXPECT_FALSE(displays.displays(0).has_layout());

  const ActiveDisplayPtr display = server.broadcaster().displays("scene").front();
  const absl::StatusOr<AtlasLayout> layout = makeAtlasLayout(
      display->spec,
      {.source_intrinsics = {.focal_px = {4, 4}}, .source_size_px = {4, 4}, .focal_distance_m = 1});
  ASSERT_TRUE(layout.ok()) << layout.status();
  server.broadcaster().noteLayout(display->id, std::make_shared<const AtlasLayout>(*layout));
  displays = list();
  EXPECT_EQ(displays.displays(0).layout().columns(), 2u);
  EXPECT_EQ(displays.displays(0).layout().encoding().jpeg_quality(),
            display->encoding.jpeg_quality);
  EXPECT_EQ(displays.displays(0).atlas_count(), 0u);
}

TEST(CatalogService, listsPresetsWithTheirLayouts) {
  TestServer server;
  const auto stub = v1::CatalogService::NewStub(server.connect());
  grpc::ClientContext context;
  v1::ListPresetsResponse response;
  ASSERT_TRUE(stub->ListPresets(&context, {}, &response).ok());
  std::vector<std::string> names;
  for (const v1::Preset& preset : response.presets()) {
    names.push_back(preset.name());
    EXPECT_EQ(preset.layout().views_size(), 0);
    EXPECT_FALSE(preset.layout().has_encoding());
    if (preset.name() == "wowvx_declipse") {
      EXPECT_THAT(preset.kinds(), ::testing::ElementsAre("rgbd"));
      EXPECT_EQ(preset.layout().rows(), 2u);
      EXPECT_FALSE(preset.layout().has_size()) << "not published";
      EXPECT_THAT(preset.note(), ::testing::HasSubstr("header"));
    }
    if (preset.name() != "portrait") continue;
    EXPECT_THAT(preset.device(), ::testing::StartsWith("Looking Glass Portrait"));
    EXPECT_EQ(preset.layout().columns(), 8u);
    EXPECT_EQ(preset.layout().rows(), 6u);
    EXPECT_EQ(preset.layout().size().width(), 3360u);
    EXPECT_EQ(preset.layout().tile_size().height(), 560u);
    EXPECT_EQ(preset.layout().view_count(), 48u);
    EXPECT_EQ(preset.layout().suffix(), "_qs8x6a0.75");
    EXPECT_EQ(preset.layout().focal_distance_m(), 0);
  }
  EXPECT_THAT(names,
              ::testing::IsSupersetOf({"near_eye_2013", "portrait", "wowvx", "wowvx_declipse"}));
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
}

TEST(CatalogService, saysWhatTheServerIsAndAccepts) {
  TestServer server({.display_count_max = 5, .subscriber_count_max = 6}, 7);
  const auto stub = v1::CatalogService::NewStub(server.connect());
  grpc::ClientContext context;
  v1::GetServerInfoResponse info;
  ASSERT_TRUE(stub->GetServerInfo(&context, {}, &info).ok());
  EXPECT_EQ(info.version(), "1.2.3");
  EXPECT_EQ(info.ingest_limits().plane_side_px_max(), 8192u);
  EXPECT_EQ(info.atlas_side_px_max(), 16384u);
  EXPECT_EQ(info.stream_count_max(), 7u);
  EXPECT_EQ(info.display_count_max(), 5u);
  EXPECT_EQ(info.subscriber_count_max(), 6u);
}

v1::AdviseSourceRequest quiltBetween(double near_m, double far_m) {
  v1::AdviseSourceRequest request;
  v1::QuiltDisplay& quilt = *request.mutable_display()->mutable_quilt();
  quilt.set_preset("portrait");
  quilt.set_fov_y_rad(0.5);
  request.set_near_m(near_m);
  request.set_far_m(far_m);
  return request;
}

TEST(CatalogService, advisesASource) {
  TestServer server;
  const auto stub = v1::CatalogService::NewStub(server.connect());
  grpc::ClientContext context;
  v1::AdviseSourceResponse response;
  ASSERT_TRUE(stub->AdviseSource(&context, quiltBetween(1, 5), &response).ok());
  EXPECT_GT(response.size().width(), 0u);
  EXPECT_GT(response.camera().intrinsics().focal_x_px(), 0);
  EXPECT_EQ(response.layer_count(), 3u);
  EXPECT_GT(response.second_size().width(), 0u);
  EXPECT_NE(response.second_source().pose().position().x(), 0);
}

TEST(CatalogService, namesWhatItCannotAdviseFor) {
  TestServer server;
  const auto stub = v1::CatalogService::NewStub(server.connect());
  const auto refusal = [&stub](const v1::AdviseSourceRequest& request) {
    grpc::ClientContext context;
    v1::AdviseSourceResponse response;
    const grpc::Status status = stub->AdviseSource(&context, request, &response);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    return status.error_message();
  };
  EXPECT_THAT(refusal(quiltBetween(5, 1)), ::testing::StartsWith("far_m: "));
  v1::AdviseSourceRequest open_fov = quiltBetween(1, 5);
  open_fov.mutable_display()->mutable_quilt()->set_fov_y_rad(0);
  EXPECT_THAT(refusal(open_fov), ::testing::StartsWith("display.quilt.fov_y_rad: missing"));
  EXPECT_THAT(refusal({}), ::testing::StartsWith("display"));
}

TEST(Health, knowsTheServerAndItsServices) {
  TestServer server;
  const auto stub = health::Health::NewStub(server.connect());
  const auto check = [&stub](const std::string& service, health::HealthCheckResponse& response) {
    grpc::ClientContext context;
    health::HealthCheckRequest request;
    request.set_service(service);
    return stub->Check(&context, request, &response).error_code();
  };
  for (const char* service : {"", "viewloom.v1.IngestService", "viewloom.v1.DisplayService"}) {
    health::HealthCheckResponse response;
    EXPECT_EQ(check(service, response), grpc::StatusCode::OK) << service;
    EXPECT_EQ(response.status(), health::HealthCheckResponse::SERVING) << service;
  }
  health::HealthCheckResponse response;
  EXPECT_EQ(check("viewloom.v1.Nonsense", response), grpc::StatusCode::NOT_FOUND);
}

TEST(Health, watchersHearThatTheServerDrains) {
  TestServer server;
  const auto stub = health::Health::NewStub(server.connect());
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(60));
  const auto watch = stub->Watch(&context, {});
  health::HealthCheckResponse response;
  ASSERT_TRUE(watch->Read(&response));
  EXPECT_EQ(response.status(), health::HealthCheckResponse::SERVING);
  server.rpc().drain();
  ASSERT_TRUE(watch->Read(&response));
  EXPECT_EQ(response.status(), health::HealthCheckResponse::NOT_SERVING);
  context.TryCancel();
  watch->Finish();
}

// The messages are those that the reflection library itself brings.
std::unique_ptr<google::protobuf::Message> reflectionMessage(const std::string& name) {
  const auto* type = google::protobuf::DescriptorPool::generated_pool()->FindMessageTypeByName(
      "grpc.reflection.v1alpha." + name);
  if (type == nullptr) return nullptr;
  const auto* blank = google::protobuf::MessageFactory::generated_factory()->GetPrototype(type);
  return std::unique_ptr<google::protobuf::Message>(blank->New());
}

TEST(Reflection, listsTheServices) {
  TestServer server;
  const auto request = reflectionMessage("ServerReflectionRequest");
  const auto response = reflectionMessage("ServerReflectionResponse");
  ASSERT_TRUE(request != nullptr && response != nullptr);
  request->GetReflection()->SetString(
      request.get(), request->GetDescriptor()->FindFieldByName("list_services"), "*");
  const RawReply reply =
      converse(server.connect(), "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo",
               request->SerializeAsString());
  ASSERT_TRUE(reply.status.ok()) << reply.status.error_message();
  ASSERT_EQ(reply.messages.size(), 1u);
  ASSERT_TRUE(response->ParseFromString(reply.messages[0]));
  for (const char* service :
       {"viewloom.v1.IngestService", "viewloom.v1.DisplayService", "viewloom.v1.CatalogService"}) {
    EXPECT_THAT(response->DebugString(), ::testing::HasSubstr(service));
  }
}

TEST(RpcServer, refusesAPortThatIsTaken) {
  TestServer server;
  EXPECT_THROW(TestServer({}, 8, server.address()), std::runtime_error);
}

TEST(RpcServer, cancelsAReceiverThatDoesNotReadWhenItGoes) {
  std::optional<TestServer> server(std::in_place);
  TestPublisher publisher(server->connect(), "scene");
  v1::OpenDisplay open = smallQuilt("scene");
  open.mutable_display()->mutable_quilt()->mutable_size()->set_width(8192);
  open.mutable_display()->mutable_quilt()->mutable_size()->set_height(4096);
  open.set_wait_for_stream(true);
  TestWatcher never(server->connect(), open);
  TestWatcher reads(server->connect(), open);
  publisher.sendFrame(1);
  ASSERT_TRUE(reads.readAtlas().has_value());
  server.reset();  // returns although 96 MiB of an atlas wait to be read
  EXPECT_FALSE(never.readAtlas().has_value()) << "an atlas cut short has no end";
  EXPECT_FALSE(never.finish().ok());
  EXPECT_EQ(reads.finish().error_code(), grpc::StatusCode::UNAVAILABLE);
}

}  // namespace
}  // namespace viewloom::rpc_server_test
