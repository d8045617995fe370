// SPDX-License-Identifier: Apache-2.0
// Depth that the client packs and the server unpacks, against what was offered.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <utility>

#include "e2e/frame_round_trip.h"
#include "support/depth_reference.h"
#include "synthetic/synthetic_wire_frame.h"

namespace viewloom::predicted_depth_test {
namespace {

using test::Arrived;

constexpr SizePx kSize_px{320, 180};

Arrived sendPredicted(WireFrame frame) {
  PublisherOptions options;
  options.predicts_depth = true;
  return test::sendFrame(std::move(frame), options);
}

TEST(PredictedDepth, reachesTheServerWithinHalfAStep) {
  const WireFrame frame =
      syntheticWireFrame({.size_px = kSize_px, .layer_count = 2, .camera = {}}, 1);
  const Arrived arrived = sendPredicted(frame);
  ASSERT_NE(arrived.frame, nullptr);
  const double step = arrived.sent.depth.at(0).step;
  ASSERT_GT(step, 0);
  const Camera& camera = arrived.frame->format.sources.at(0).camera;
  size_t surfaces = 0;
  size_t wire_bytes = 0;
  for (size_t l = 0; l < 2; ++l) {
    const PlaneFormat& declared = arrived.frame->format.sources[0].layers.at(l).depth;
    ASSERT_EQ(declared.compression, PlaneCompression::kPredictedZstd);
    wire_bytes += declared.wire_bytes;
    const std::vector<uint8_t>& samples = *arrived.frame->sources[0].at(l).depth;
    const std::vector<uint8_t>& offered = *frame.planes.at(2 * l + 1);
    for (uint32_t i = 0; i < kSize_px.area(); ++i) {
      float depth_m = 0;
      std::memcpy(&depth_m, &offered[i * sizeof(depth_m)], sizeof(depth_m));
      const double sample = samples.at(2 * i) + 256.0 * samples.at(2 * i + 1);
      const DepthValue value =
          linearizeDepth(declared.depth, declared.encoding, sample,
                         {i % kSize_px.width, i / kSize_px.width}, camera.intrinsics);
      ASSERT_EQ(value.kind == DepthClass::kSurface, depth_m > 0) << i;
      if (value.kind != DepthClass::kSurface) continue;
      ++surfaces;
      ASSERT_LE(std::abs(value.inv_z - 1 / double{depth_m}), 0.5 * step + 1e-7 / depth_m) << i;
    }
  }
  EXPECT_GT(surfaces, kSize_px.area());
  EXPECT_LT(wire_bytes, 2 * kSize_px.area() * sizeof(float) / 4);
}

TEST(PredictedDepth, reachesTheServerToTheBitWhenItHasSixteenBits) {
  WireFrame frame;
  v1::Source& source = *frame.header.add_sources();
  source.mutable_camera()->mutable_intrinsics()->set_focal_x_px(40);
  source.mutable_camera()->mutable_intrinsics()->set_focal_y_px(40);
  v1::Layer& layer = *source.add_layers();
  const auto add = [&](v1::PlaneKind kind, v1::PlaneEncoding encoding, size_t byte_count) {
    v1::Plane& plane = *layer.add_planes();
    plane.set_kind(kind);
    plane.set_encoding(encoding);
    plane.mutable_size()->set_width(32);
    plane.mutable_size()->set_height(20);
    plane.set_bytes_count(byte_count);
    std::vector<uint8_t> bytes(byte_count);
    for (size_t i = 0; i < byte_count; ++i) bytes[i] = static_cast<uint8_t>(i / 64 + i % 2 * 3);
    frame.planes.push_back(std::make_shared<const std::vector<uint8_t>>(std::move(bytes)));
  };
  add(v1::PLANE_KIND_COLOR, v1::PLANE_ENCODING_RGB8, 32 * 20 * 3);
  add(v1::PLANE_KIND_DEPTH, v1::PLANE_ENCODING_DEPTH_U16, 32 * 20 * 2);
  layer.mutable_planes(1)->mutable_depth()->set_meaning(v1::DEPTH_MEANING_PLANAR);
  layer.mutable_planes(1)->mutable_depth()->set_scale(0.001);
  const Arrived arrived = sendPredicted(frame);
  ASSERT_NE(arrived.frame, nullptr);
  EXPECT_LT(arrived.sent.frame.planes.at(1)->size(), frame.planes[1]->size() / 2);
  EXPECT_EQ(*arrived.frame->sources.at(0).at(0).depth, *frame.planes[1]);
}

}  // namespace
}  // namespace viewloom::predicted_depth_test
