// SPDX-License-Identifier: Apache-2.0
// Headers with planes of motion that cannot be, or are not served yet.
#include <gtest/gtest.h>

#include "e2e/bad_header.h"
#include "e2e/test_server.h"

namespace viewloom::rpc_bad_motion_test {
namespace {

const std::string kMotionPath = kSourcePath + "layers[0].planes[2].";

// Adds a valid motion plane. Colour must have the size of depth.
v1::Plane& addMotion(v1::FrameHeader& header) {
  const v1::SizePx size = depth(header).size();
  setSize(color(header), size.width(), size.height());
  color(header).set_bytes_count(uint64_t{3} * size.width() * size.height());
  v1::Plane& plane = *layerOf(header).add_planes();
  plane.set_kind(v1::PLANE_KIND_MOTION);
  plane.set_encoding(v1::PLANE_ENCODING_XYZ16F);
  *plane.mutable_size() = size;
  plane.set_bytes_count(uint64_t{6} * size.width() * size.height());
  return plane;
}

const std::vector<BadHeader> kMotions = {
    {"of bytes", [](auto& h) { addMotion(h).set_encoding(v1::PLANE_ENCODING_XYZ8); }, kInvalid,
     kMotionPath + "encoding"},
    {"of another size", [](auto& h) { setSize(addMotion(h), 1, 1); }, kInvalid,
     kMotionPath + "bytes_count"},
    {"of another size, with its bytes",
     [](auto& h) {
       v1::Plane& motion = addMotion(h);
       setSize(motion, 1, 1);
       motion.set_bytes_count(6);
     },
     kInvalid, kMotionPath + "size"},
    {"predicted",
     [](auto& h) { addMotion(h).set_compression(v1::PLANE_COMPRESSION_PREDICTED_ZSTD); }, kInvalid,
     kMotionPath + "compression"},
    {"twice",
     [](auto& h) {
       addMotion(h);
       addMotion(h);
     },
     kInvalid, kSourcePath + "layers[0].planes[3].kind"},
    {"under colour of another size",
     [](auto& h) {
       addMotion(h);
       setSize(color(h), 4, 3);
       color(h).set_bytes_count(36);
     },
     kLater, kMotionPath + "kind"},
    {"under colours of two transfers",
     [](auto& h) {
       addMotion(h);
       *h.mutable_sources(0)->add_layers() = layerOf(h);
       v1::Layer& second = *h.mutable_sources(0)->mutable_layers(1);
       second.mutable_planes(0)->set_transfer(v1::COLOR_TRANSFER_LINEAR);
     },
     kLater, kMotionPath + "kind"},
    {"of a cube map",
     [](auto& h) {
       addMotion(h);
       h.mutable_sources(0)->set_cube_map(true);
       camera(h).clear_projection();
       for (v1::Plane& plane : *layerOf(h).mutable_planes()) setSize(plane, 2, 12);
       color(h).set_bytes_count(2 * 12 * 3);
       depth(h).set_bytes_count(2 * 12 * 4);
       layerOf(h).mutable_planes(2)->set_bytes_count(2 * 12 * 6);
     },
     kLater, kMotionPath + "kind"},
};

TEST(PublishFrames, refusesMotionThatCannotBe) {
  expectRefused(kMotions);
}

TEST(PublishFrames, takesTheMotionThatTheBadOnesAreMadeFrom) {
  TestServer server;
  TestPublisher publisher(server.connect(), "good");
  v1::FrameHeader header = smallHeader(1);
  const v1::Plane motion = addMotion(header);
  ASSERT_TRUE(publisher.sendHeader(header));
  ASSERT_TRUE(publisher.sendChunk(chunkOf(0, 0, std::string(color(header).bytes_count(), 'c'))));
  ASSERT_TRUE(publisher.sendChunk(chunkOf(1, 0, std::string(depth(header).bytes_count(), '@'))));
  ASSERT_TRUE(publisher.sendChunk(chunkOf(2, 0, std::string(motion.bytes_count(), '\x7f'))));
  EXPECT_EQ(publisher.readReport()->outcome(), v1::FRAME_OUTCOME_BUILT_WITHOUT_DISPLAY);
}

}  // namespace
}  // namespace viewloom::rpc_bad_motion_test
