// SPDX-License-Identifier: Apache-2.0
// Headers of cube maps that cannot be, or are not served yet.
#include <gtest/gtest.h>

#include "e2e/bad_header.h"
#include "e2e/test_server.h"

namespace viewloom::rpc_bad_cube_maps_test {
namespace {

// Makes the source a valid cube map with 6 px a side.
void makeCubeMap(v1::FrameHeader& header) {
  header.mutable_sources(0)->set_cube_map(true);
  camera(header).clear_projection();
  setSize(color(header), 6, 36);
  color(header).set_bytes_count(6 * 36 * 3);
  setSize(depth(header), 6, 36);
  depth(header).set_bytes_count(6 * 36 * 4);
}

const std::vector<BadHeader> kCubeMaps = {
    {"of a wide plane",
     [](auto& h) {
       h.mutable_sources(0)->set_cube_map(true);
       camera(h).clear_projection();
     },
     kInvalid, kColorPath + "size"},
    {"of five faces",
     [](auto& h) {
       makeCubeMap(h);
       setSize(color(h), 6, 30);
     },
     kInvalid, kColorPath + "size"},
    {"of oblong faces",
     [](auto& h) {
       makeCubeMap(h);
       setSize(depth(h), 6, 42);
     },
     kInvalid, kDepthPath + "size"},
    {"of nothing",
     [](auto& h) {
       makeCubeMap(h);
       setSize(color(h), 0, 0);
     },
     kInvalid, kColorPath + "size"},
    {"of large faces",
     [](auto& h) {
       makeCubeMap(h);
       setSize(color(h), 8193, 6 * 8193);
     },
     kTooMuch, kColorPath + "size"},
    {"with colour of another size",
     [](auto& h) {
       makeCubeMap(h);
       setSize(color(h), 3, 18);
       color(h).set_bytes_count(3 * 18 * 3);
     },
     kInvalid, kColorPath + "size"},
    {"with angles",
     [](auto& h) {
       makeCubeMap(h);
       camera(h).mutable_fov()->set_angle_right_rad(0.7);
     },
     kInvalid, kSourcePath + "camera.fov"},
    {"with intrinsics",
     [](auto& h) {
       makeCubeMap(h);
       camera(h).mutable_intrinsics()->set_focal_x_px(3);
     },
     kInvalid, kSourcePath + "camera.intrinsics"},
    {"semitransparent",
     [](auto& h) {
       makeCubeMap(h);
       color(h).set_alpha(v1::ALPHA_MODE_PREMULTIPLIED);
     },
     kLater, kColorPath + "alpha"},
};

TEST(PublishFrames, refusesCubeMapsThatCannotBe) {
  expectRefused(kCubeMaps);
}

TEST(PublishFrames, takesTheCubeMapThatTheBadOnesAreMadeFrom) {
  TestServer server;
  TestPublisher publisher(server.connect(), "good");
  v1::FrameHeader header = smallHeader(1);
  makeCubeMap(header);
  ASSERT_TRUE(publisher.sendHeader(header));
  ASSERT_TRUE(publisher.sendChunk(chunkOf(0, 0, std::string(color(header).bytes_count(), 'c'))));
  ASSERT_TRUE(publisher.sendChunk(chunkOf(1, 0, std::string(depth(header).bytes_count(), '@'))));
  EXPECT_EQ(publisher.readReport()->outcome(), v1::FRAME_OUTCOME_BUILT_WITHOUT_DISPLAY);
}

}  // namespace
}  // namespace viewloom::rpc_bad_cube_maps_test
