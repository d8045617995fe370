// SPDX-License-Identifier: Apache-2.0
#include "lib/compress_frame.h"

#include <gtest/gtest.h>
#include <zstd.h>

#include <memory>
#include <random>

namespace viewloom {
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
  const WireFrame packed = compressFrame(frame, 1);
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

}  // namespace
}  // namespace viewloom
