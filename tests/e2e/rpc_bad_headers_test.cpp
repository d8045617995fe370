// SPDX-License-Identifier: Apache-2.0
// Frame headers that cannot be: each with the status and the field it is refused with.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "e2e/bad_header.h"
#include "e2e/test_server.h"

namespace viewloom::rpc_bad_headers_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
void setLayers(v1::FrameHeader& header, int count) {
  const v1::Layer layer = layerOf(header);
  header.mutable_sources(0)->clear_layers();
  for (int i = 0; i < count; ++i) *header.mutable_sources(0)->add_layers() = layer;
}

v1::Plane& addPlane(v1::FrameHeader& header, int kind) {
  v1::Plane& plane = *layerOf(header).add_planes();
  plane = color(header);
  plane.set_kind(static_cast<v1::PlaneKind>(kind));
  return plane;
}

// One that is as it should be.
v1::Plane& addSurface(v1::FrameHeader& header, v1::PlaneKind kind, v1::PlaneEncoding encoding,
                      uint32_t px_bytes) {
  v1::Plane& plane = addPlane(header, kind);
  plane.set_encoding(encoding);
  *plane.mutable_size() = depth(header).size();
  plane.set_bytes_count(uint64_t{px_bytes} * plane.size().width() * plane.size().height());
  return plane;
}

// 3 GiB, each plane within its own limits.
void makeHuge(v1::FrameHeader& header) {
  setSize(color(header), 8192, 8192);
  color(header).set_encoding(v1::PLANE_ENCODING_RGBA16F);
  color(header).set_bytes_count(uint64_t{512} << 20);
  setSize(depth(header), 8192, 8192);
  depth(header).set_bytes_count(uint64_t{256} << 20);
  setLayers(header, 4);
}

void makeWindow(v1::FrameHeader& header, double near_z_m, double far_z_m) {
  v1::DepthFormat& format = *depth(header).mutable_depth();
  format.set_meaning(v1::DEPTH_MEANING_WINDOW);
  format.set_near_z_m(near_z_m);
  format.set_far_z_m(far_z_m);
}

const std::vector<BadHeader> kSizes = {
    {"no depth", [](auto& h) { setSize(depth(h), 0, 4); }, kInvalid, kDepthPath + "size"},
    {"no color", [](auto& h) { setSize(color(h), 4, 0); }, kInvalid, kColorPath + "size"},
    {"too wide", [](auto& h) { setSize(color(h), 8193, 1); }, kTooMuch, kColorPath + "size"},
    {"overflows", [](auto& h) { setSize(depth(h), ~0u, ~0u); }, kTooMuch, kDepthPath + "size"},
    {"one byte more", [](auto& h) { color(h).set_bytes_count(49); }, kInvalid,
     kColorPath + "bytes_count"},
    {"one byte less", [](auto& h) { depth(h).set_bytes_count(63); }, kInvalid,
     kDepthPath + "bytes_count"},
    {"no bytes", [](auto& h) { color(h).set_bytes_count(0); }, kInvalid,
     kColorPath + "bytes_count"},
    {"predicted colour",
     [](auto& h) { color(h).set_compression(v1::PLANE_COMPRESSION_PREDICTED_ZSTD); }, kInvalid,
     kColorPath + "compression"},
    {"more bytes than zstd makes",
     [](auto& h) {
       color(h).set_compression(v1::PLANE_COMPRESSION_ZSTD);
       color(h).set_bytes_count(~uint64_t{0});
     },
     kInvalid, kColorPath + "bytes_count"},
    {"narrow stride", [](auto& h) { color(h).set_stride_bytes(11); }, kInvalid,
     kColorPath + "stride_bytes"},
    {"huge stride", [](auto& h) { color(h).set_stride_bytes(~0u); }, kInvalid,
     kColorPath + "stride_bytes"},
    {"3 GiB", makeHuge, kTooMuch, "header"},
    {"layers of two sizes",
     [](auto& h) {
       setLayers(h, 2);
       v1::Plane& second = *h.mutable_sources(0)->mutable_layers(1)->mutable_planes(1);
       setSize(second, 2, 8);
     },
     kInvalid, kSourcePath + "layers[1].planes[1].size"},
};

const std::vector<BadHeader> kCounts = {
    {"number 0", [](auto& h) { h.set_number(0); }, kInvalid, "header.number"},
    {"no source", [](auto& h) { h.clear_sources(); }, kInvalid, "header.sources"},
    {"a second source without camera",
     [](auto& h) {
       *h.add_sources() = h.sources(0);
       h.mutable_sources(1)->clear_camera();
     },
     kInvalid, "header.sources[1].camera.projection"},
    {"nine sources",
     [](auto& h) {
       for (int i = 0; i < 8; ++i) *h.add_sources() = h.sources(0);
     },
     kInvalid, "header.sources"},
    {"no layer", [](auto& h) { setLayers(h, 0); }, kInvalid, kSourcePath + "layers"},
    {"five layers", [](auto& h) { setLayers(h, 5); }, kInvalid, kSourcePath + "layers"},
    {"no plane", [](auto& h) { layerOf(h).clear_planes(); }, kInvalid,
     kSourcePath + "layers[0].planes"},
    {"no depth plane", [](auto& h) { layerOf(h).mutable_planes()->RemoveLast(); }, kInvalid,
     kSourcePath + "layers[0].planes"},
    {"two color planes", [](auto& h) { addPlane(h, v1::PLANE_KIND_COLOR); }, kInvalid,
     kSourcePath + "layers[0].planes[2].kind"},
};

const std::vector<BadHeader> kEnums = {
    {"no kind", [](auto& h) { addPlane(h, 0); }, kInvalid,
     kSourcePath + "layers[0].planes[2].kind"},
    {"kind 99", [](auto& h) { addPlane(h, 99); }, kInvalid,
     kSourcePath + "layers[0].planes[2].kind"},
    {"no encoding", [](auto& h) { color(h).clear_encoding(); }, kInvalid, kColorPath + "encoding"},
    {"encoding 99", [](auto& h) { color(h).set_encoding(static_cast<v1::PlaneEncoding>(99)); },
     kInvalid, kColorPath + "encoding"},
    {"color as depth", [](auto& h) { depth(h).set_encoding(v1::PLANE_ENCODING_RGBA8); }, kInvalid,
     kDepthPath + "encoding"},
    {"compression 99",
     [](auto& h) { color(h).set_compression(static_cast<v1::PlaneCompression>(99)); }, kInvalid,
     kColorPath + "compression"},
    {"transfer 99", [](auto& h) { color(h).set_transfer(static_cast<v1::ColorTransfer>(99)); },
     kInvalid, kColorPath + "transfer"},
    {"primaries -1", [](auto& h) { color(h).set_primaries(static_cast<v1::ColorPrimaries>(-1)); },
     kInvalid, kColorPath + "primaries"},
    {"alpha 99", [](auto& h) { color(h).set_alpha(static_cast<v1::AlphaMode>(99)); }, kInvalid,
     kColorPath + "alpha"},
    {"no meaning", [](auto& h) { depth(h).clear_depth(); }, kInvalid, kDepthPath + "depth.meaning"},
    {"meaning 99",
     [](auto& h) { depth(h).mutable_depth()->set_meaning(static_cast<v1::DepthMeaning>(99)); },
     kInvalid, kDepthPath + "depth.meaning"},
};

const std::string kThirdPath = kSourcePath + "layers[0].planes[2].";

const std::vector<BadHeader> kSurfaces = {
    {"normals as colour",
     [](auto& h) { addSurface(h, v1::PLANE_KIND_NORMAL, v1::PLANE_ENCODING_RGB8, 3); }, kInvalid,
     kThirdPath + "encoding"},
    {"roughness beyond 0..1",
     [](auto& h) { addSurface(h, v1::PLANE_KIND_ROUGHNESS, v1::PLANE_ENCODING_DEPTH_F32, 4); },
     kInvalid, kThirdPath + "encoding"},
    {"specular JPEG",
     [](auto& h) { addSurface(h, v1::PLANE_KIND_SPECULAR, v1::PLANE_ENCODING_JPEG, 1); }, kInvalid,
     kThirdPath + "encoding"},
    {"normals of another size",
     [](auto& h) {
       v1::Plane& plane = addSurface(h, v1::PLANE_KIND_NORMAL, v1::PLANE_ENCODING_OCT16, 4);
       setSize(plane, 1, 1);
       plane.set_bytes_count(4);
     },
     kInvalid, kThirdPath + "size"},
    {"normals a byte short",
     [](auto& h) {
       v1::Plane& plane = addSurface(h, v1::PLANE_KIND_NORMAL, v1::PLANE_ENCODING_XYZ16F, 6);
       plane.set_bytes_count(plane.bytes_count() - 1);
     },
     kInvalid, kThirdPath + "bytes_count"},
    {"normals of no known space",
     [](auto& h) {
       addSurface(h, v1::PLANE_KIND_NORMAL, v1::PLANE_ENCODING_XYZ8, 3)
           .set_normal_space(static_cast<v1::NormalSpace>(9));
     },
     kInvalid, kThirdPath + "normal_space"},
    {"predicted roughness",
     [](auto& h) {
       addSurface(h, v1::PLANE_KIND_ROUGHNESS, v1::PLANE_ENCODING_R8, 1)
           .set_compression(v1::PLANE_COMPRESSION_PREDICTED_ZSTD);
     },
     kInvalid, kThirdPath + "compression"},
    {"two planes of normals",
     [](auto& h) {
       addSurface(h, v1::PLANE_KIND_NORMAL, v1::PLANE_ENCODING_XYZ8, 3);
       addSurface(h, v1::PLANE_KIND_NORMAL, v1::PLANE_ENCODING_XYZ8, 3);
     },
     kInvalid, kSourcePath + "layers[0].planes[3].kind"},
    {"normals before depth",
     [](auto& h) {
       addSurface(h, v1::PLANE_KIND_NORMAL, v1::PLANE_ENCODING_XYZ8, 3);
       layerOf(h).mutable_planes()->SwapElements(1, 2);
     },
     kInvalid, kSourcePath + "layers[0].planes[1].kind"},
};

const std::vector<BadHeader> kCameras = {
    {"NaN position", [](auto& h) { camera(h).mutable_pose()->mutable_position()->set_x(kNan); },
     kInvalid, kCameraPath + "pose.position"},
    {"infinite position",
     [](auto& h) { camera(h).mutable_pose()->mutable_position()->set_z(-kInfinity); }, kInvalid,
     kCameraPath + "pose.position"},
    {"NaN orientation",
     [](auto& h) { camera(h).mutable_pose()->mutable_orientation()->set_y(kNan); }, kInvalid,
     kCameraPath + "pose.orientation"},
    {"long quaternion",
     [](auto& h) { camera(h).mutable_pose()->mutable_orientation()->set_w(1.01); }, kInvalid,
     kCameraPath + "pose.orientation"},
    {"zero field of view", [](auto& h) { camera(h).mutable_fov()->set_angle_right_rad(-0.5); },
     kInvalid, kCameraPath + "fov.angle_right_rad"},
    {"crossed field of view", [](auto& h) { camera(h).mutable_fov()->set_angle_up_rad(-0.6); },
     kInvalid, kCameraPath + "fov.angle_up_rad"},
    {"right angle", [](auto& h) { camera(h).mutable_fov()->set_angle_left_rad(-M_PI / 2); },
     kInvalid, kCameraPath + "fov.angle_left_rad"},
    {"NaN angle", [](auto& h) { camera(h).mutable_fov()->set_angle_down_rad(kNan); }, kInvalid,
     kCameraPath + "fov.angle_down_rad"},
    {"no projection", [](auto& h) { camera(h).clear_fov(); }, kInvalid, kCameraPath + "projection"},
    {"no focal length", [](auto& h) { camera(h).mutable_intrinsics(); }, kInvalid,
     kCameraPath + "intrinsics.focal_x_px"},
    {"infinite principal point",
     [](auto& h) {
       v1::Intrinsics& intrinsics = *camera(h).mutable_intrinsics();
       intrinsics.set_focal_x_px(1);
       intrinsics.set_focal_y_px(1);
       intrinsics.set_principal_y_px(kInfinity);
     },
     kInvalid, kCameraPath + "intrinsics.principal_y_px"},
};

const std::vector<BadHeader> kNumbers = {
    {"near = far", [](auto& h) { makeWindow(h, 2, 2); }, kInvalid, kDepthPath + "depth.far_z_m"},
    {"near behind the eye", [](auto& h) { makeWindow(h, -1, 2); }, kInvalid,
     kDepthPath + "depth.near_z_m"},
    {"NaN far", [](auto& h) { makeWindow(h, 1, kNan); }, kInvalid, kDepthPath + "depth.far_z_m"},
    {"NaN scale", [](auto& h) { depth(h).mutable_depth()->set_scale(kNan); }, kInvalid,
     kDepthPath + "depth.scale"},
    {"infinite offset", [](auto& h) { depth(h).mutable_depth()->set_offset(kInfinity); }, kInvalid,
     kDepthPath + "depth.offset"},
    {"negative tolerance", [](auto& h) { h.mutable_sources(0)->set_connection_tolerance(-1); },
     kInvalid, kSourcePath + "connection_tolerance"},
    {"NaN tolerance", [](auto& h) { h.mutable_sources(0)->set_connection_tolerance(kNan); },
     kInvalid, kSourcePath + "connection_tolerance"},
    {"33 stops", [](auto& h) { h.set_exposure_ev(33); }, kInvalid, "header.exposure_ev"},
    {"NaN stops", [](auto& h) { h.set_exposure_ev(kNan); }, kInvalid, "header.exposure_ev"},
};

TEST(PublishFrames, refusesSizesThatCannotBe) {
  expectRefused(kSizes);
}
TEST(PublishFrames, refusesWrongCounts) {
  expectRefused(kCounts);
}
TEST(PublishFrames, refusesWhatItDoesNotKnowOrDoesNotServeYet) {
  expectRefused(kEnums);
}
TEST(PublishFrames, refusesPlanesThatDoNotSayHowASurfaceMirrors) {
  expectRefused(kSurfaces);
}
TEST(PublishFrames, refusesCamerasThatCannotBe) {
  expectRefused(kCameras);
}
TEST(PublishFrames, refusesNumbersThatCannotBe) {
  expectRefused(kNumbers);
}

TEST(PublishFrames, takesTheHeaderThatTheBadOnesAreMadeFrom) {
  TestServer server;
  TestPublisher publisher(server.connect(), "good");
  ASSERT_TRUE(publisher.sendFrame(1));
  EXPECT_EQ(publisher.readReport()->outcome(), v1::FRAME_OUTCOME_BUILT_WITHOUT_DISPLAY);
}

}  // namespace
}  // namespace viewloom::rpc_bad_headers_test
