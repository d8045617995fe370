// SPDX-License-Identifier: Apache-2.0
// Messages that are large in memory before anybody has looked at them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "e2e/raw_call.h"
#include "e2e/test_server.h"
#include "viewloom/v1/catalog_service.pb.h"
#include "viewloom/v1/display_service.pb.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom::rpc_large_messages_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kPublishFrames = "/viewloom.v1.IngestService/PublishFrames";
constexpr const char* kStreamAtlases = "/viewloom.v1.DisplayService/StreamAtlases";
constexpr const char* kAdviseSource = "/viewloom.v1.CatalogService/AdviseSource";

v1::Display manyCameras(int count, const v1::Camera& camera) {
  v1::Display display;
  for (int i = 0; i < count; ++i) *display.mutable_cameras()->add_cameras() = camera;
  return display;
}

v1::Camera largestCamera() {
  v1::Camera camera;
  for (const auto set : {&v1::Vector3::set_x, &v1::Vector3::set_y, &v1::Vector3::set_z}) {
    (camera.mutable_pose()->mutable_position()->*set)(-0.1);
  }
  for (const auto set : {&v1::Quaternion::set_x, &v1::Quaternion::set_y, &v1::Quaternion::set_z,
                         &v1::Quaternion::set_w}) {
    (camera.mutable_pose()->mutable_orientation()->*set)(-0.5);
  }
  for (const auto set : {&v1::Fov::set_angle_left_rad, &v1::Fov::set_angle_right_rad,
                         &v1::Fov::set_angle_up_rad, &v1::Fov::set_angle_down_rad}) {
    (camera.mutable_fov()->*set)(-0.5);
  }
  return camera;
}

class LargeMessages : public testing::Test {
 protected:
  std::string errorOf(const char* method, const google::protobuf::MessageLite& message) {
    return converse(server_.connect(), method, message.SerializeAsString()).status.error_message();
  }

  TestServer server_;
};

// Two bytes a plane take a hundred once they are read.
TEST_F(LargeMessages, readsNoHeaderOfManyEmptyPlanes) {
  v1::PublishFramesRequest request;
  v1::Layer& layer = *request.mutable_header()->add_sources()->add_layers();
  for (int i = 0; i < 40'000; ++i) layer.add_planes();
  EXPECT_THAT(errorOf(kPublishFrames, request), HasSubstr("accepted is up to 65536"));
}

TEST_F(LargeMessages, readsTheHeaderOfTheLargestFrame) {
  v1::PublishFramesRequest request;
  for (int source = 0; source < 8; ++source) {
    v1::Source& added = *request.mutable_header()->add_sources();
    *added.mutable_camera() = largestCamera();
    for (int layer = 0; layer < 4; ++layer) {
      v1::Layer& planes = *added.add_layers();
      for (int plane = 0; plane < 8; ++plane) {
        planes.add_planes()->set_bytes_count(~uint64_t{0});
        planes.mutable_planes(plane)->mutable_size()->set_width(~0U);
      }
    }
  }
  EXPECT_THAT(errorOf(kPublishFrames, request), HasSubstr("accepted first is settings"));
}

TEST_F(LargeMessages, readsNoDisplayOfManyEmptyCameras) {
  const v1::Display display = manyCameras(200'000, {});
  v1::StreamAtlasesRequest open;
  *open.mutable_open()->mutable_display() = display;
  EXPECT_THAT(errorOf(kStreamAtlases, open), HasSubstr("accepted is up to 262144"));
  v1::AdviseSourceRequest advise;
  *advise.mutable_display() = display;
  EXPECT_THAT(errorOf(kAdviseSource, advise), HasSubstr("accepted is up to 262144"));
}

TEST_F(LargeMessages, areRefusedInATimeThatIsMeasured) {
  v1::StreamAtlasesRequest open;
  *open.mutable_open()->mutable_display() = manyCameras(200'000, {});
  EXPECT_THAT(errorOf(kStreamAtlases, open), HasSubstr("accepted is up to 262144"));
  EXPECT_THAT(server_.metrics().text(), HasSubstr("viewloom_call_refusal_seconds_count 1"));
}

TEST_F(LargeMessages, readsTheLargestDisplay) {
  v1::StreamAtlasesRequest open;
  open.mutable_open()->set_stream("none");
  *open.mutable_open()->mutable_display() = manyCameras(1024, largestCamera());
  EXPECT_THAT(errorOf(kStreamAtlases, open), Not(HasSubstr("accepted is up to 262144")));
}

}  // namespace
}  // namespace viewloom::rpc_large_messages_test
