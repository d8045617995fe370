// SPDX-License-Identifier: Apache-2.0
#include "lib/compress_frame.h"

#include <gtest/gtest.h>
#include <zstd.h>

#include <cstring>
#include <memory>
#include <random>

#include "unit/client/predicted_oracle.h"

namespace viewloom::compress_frame_test {
namespace {

void addPlane(WireFrame& frame, v1::PlaneEncoding encoding, std::vector<uint8_t> bytes) {
  if (frame.header.sources_size() == 0) frame.header.add_sources()->add_layers();
  v1::Plane& plane = *frame.header.mutable_sources(0)->mutable_layers(0)->add_planes();
  plane.set_encoding(encoding);
  plane.set_bytes_count(bytes.size());
  frame.planes.push_back(std::make_shared<const std::vector<uint8_t>>(std::move(bytes)));
}

TEST(CompressFrame, packsWhatGetsSmallerAndLeavesTheRest) {
  const std::vector<uint8_t> flat(10000, 7);
  std::vector<uint8_t> noise(10000);
  std::mt19937 random(1);
  for (uint8_t& byte : noise) byte = static_cast<uint8_t>(random());
  WireFrame frame;
  addPlane(frame, v1::PLANE_ENCODING_RGBA8, flat);
  addPlane(frame, v1::PLANE_ENCODING_DEPTH_F32, noise);
  addPlane(frame, v1::PLANE_ENCODING_JPEG, flat);
  const WireFrame packed = compressFrame(frame, {.zstd_level = 1}).frame;
  const auto& planes = packed.header.sources(0).layers(0).planes();

  EXPECT_EQ(planes[0].compression(), v1::PLANE_COMPRESSION_ZSTD);
  EXPECT_EQ(planes[0].bytes_count(), packed.planes[0]->size());
  std::vector<uint8_t> unpacked(flat.size());
  EXPECT_EQ(ZSTD_decompress(unpacked.data(), unpacked.size(), packed.planes[0]->data(),
                            packed.planes[0]->size()),
            flat.size());
  EXPECT_EQ(unpacked, flat);
  for (int plane : {1, 2}) {
    EXPECT_NE(planes[plane].compression(), v1::PLANE_COMPRESSION_ZSTD);
    EXPECT_EQ(*packed.planes[static_cast<size_t>(plane)],
              *frame.planes[static_cast<size_t>(plane)]);
  }
}

// A layer of colour and of binary32 depth, a slanted plane; 40x30.
WireFrame slantedFrame() {
  WireFrame frame;
  addPlane(frame, v1::PLANE_ENCODING_RGB8, std::vector<uint8_t>(40 * 30 * 3, 5));
  std::vector<uint8_t> depth(40 * 30 * sizeof(float));
  for (size_t i = 0; i < 40 * 30; ++i) {
    const float depth_m = 1 / (0.2F + 0.001F * static_cast<float>(i % 40));
    std::memcpy(&depth[i * sizeof(float)], &depth_m, sizeof(float));
  }
  addPlane(frame, v1::PLANE_ENCODING_DEPTH_F32, depth);
  v1::Source& source = *frame.header.mutable_sources(0);
  source.mutable_camera()->mutable_intrinsics()->set_focal_x_px(40);
  source.mutable_camera()->mutable_intrinsics()->set_focal_y_px(40);
  v1::Plane& plane = *source.mutable_layers(0)->mutable_planes(1);
  plane.set_kind(v1::PLANE_KIND_DEPTH);
  plane.mutable_depth()->set_meaning(v1::DEPTH_MEANING_PLANAR);
  plane.mutable_size()->set_width(40);
  plane.mutable_size()->set_height(30);
  return frame;
}

std::vector<uint8_t> inflated(const std::vector<uint8_t>& packed, size_t size) {
  std::vector<uint8_t> bytes(size);
  EXPECT_EQ(ZSTD_decompress(bytes.data(), bytes.size(), packed.data(), packed.size()), size);
  return bytes;
}

TEST(CompressFrame, predictsDepthAndLeavesColourWhenOnlyThatIsAsked) {
  const WireFrame frame = slantedFrame();
  const CompressedFrame compressed = compressFrame(frame, {.predicts_depth = true});
  EXPECT_EQ(compressed.frame.planes[0], frame.planes[0]);
  const v1::Plane& depth = compressed.frame.header.sources(0).layers(0).planes(1);
  EXPECT_EQ(depth.encoding(), v1::PLANE_ENCODING_DEPTH_U16);
  EXPECT_EQ(depth.compression(), v1::PLANE_COMPRESSION_PREDICTED_ZSTD);
  EXPECT_EQ(depth.bytes_count(), compressed.frame.planes[1]->size());
  ASSERT_EQ(compressed.depth.size(), 1U);
  EXPECT_EQ(compressed.depth[0].step, depth.depth().scale());
  const std::vector<uint16_t> codes =
      test::unpredict(inflated(*compressed.frame.planes[1], 2 * 40 * 30), 40, 30);
  for (size_t i = 0; i < codes.size(); ++i) {
    const double inv_z = codes[i] * depth.depth().scale() + depth.depth().offset();
    ASSERT_NEAR(inv_z, 0.2 + 0.001 * static_cast<double>(i % 40),
                0.5 * compressed.depth[0].step + 1e-7);
  }
}

TEST(CompressFrame, packsSixteenBitDepthWithoutLoss) {
  for (const auto encoding : {v1::PLANE_ENCODING_DEPTH_U16, v1::PLANE_ENCODING_DEPTH_F16}) {
    WireFrame frame = slantedFrame();
    v1::Plane& plane = *frame.header.mutable_sources(0)->mutable_layers(0)->mutable_planes(1);
    plane.set_encoding(encoding);
    std::vector<uint8_t> samples(2 * 40 * 30);
    for (size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<uint8_t>(i / 2 % 40 * 5);
    frame.planes[1] = std::make_shared<const std::vector<uint8_t>>(samples);
    const CompressedFrame compressed = compressFrame(frame, {.predicts_depth = true});
    const v1::Plane& depth = compressed.frame.header.sources(0).layers(0).planes(1);
    EXPECT_EQ(depth.encoding(), encoding);
    EXPECT_EQ(depth.compression(), v1::PLANE_COMPRESSION_PREDICTED_ZSTD);
    const std::vector<uint16_t> restored =
        test::unpredict(inflated(*compressed.frame.planes[1], samples.size()), 40, 30);
    EXPECT_EQ(std::memcmp(restored.data(), samples.data(), samples.size()), 0);
    EXPECT_EQ(compressed.depth[0].step, 0);
  }
}

TEST(CompressFrame, packsWhatIsTooWideForSixteenBitsAsItIs) {
  WireFrame frame = slantedFrame();
  std::vector<uint8_t> samples = *frame.planes[1];
  const float speck_m = 1e-5F;
  std::memcpy(samples.data(), &speck_m, sizeof(speck_m));
  frame.planes[1] = std::make_shared<const std::vector<uint8_t>>(samples);
  const CompressedFrame compressed = compressFrame(frame, {.predicts_depth = true});
  const v1::Plane& depth = compressed.frame.header.sources(0).layers(0).planes(1);
  EXPECT_EQ(depth.encoding(), v1::PLANE_ENCODING_DEPTH_F32);
  EXPECT_EQ(depth.compression(), v1::PLANE_COMPRESSION_ZSTD);
  EXPECT_EQ(inflated(*compressed.frame.planes[1], samples.size()), samples);
  EXPECT_NE(compressed.depth[0].kept_because, "");
}

}  // namespace
}  // namespace viewloom::compress_frame_test
