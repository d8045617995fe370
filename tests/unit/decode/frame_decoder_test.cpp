// SPDX-License-Identifier: Apache-2.0
#include "decode/frame_decoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include <string>
#include <utility>
#include <vector>

#include "frame/limits.h"
#include "unit/decode/jpeg_samples.h"
#include "unit/decode/zstd_samples.h"

namespace viewloom::frame_decoder_test {
namespace {

using Bytes = std::vector<uint8_t>;

SharedBytes shared(Bytes bytes) {
  return std::make_shared<const Bytes>(std::move(bytes));
}

// A frame of one layer, 3x2, whose planes are filled in by each test.
struct OneLayer {
  LayerFormat layer{
      .color = {.encoding = PlaneEncoding::kRgba8, .size_px = {3, 2}},
      .depth = {
          .kind = PlaneKind::kDepth, .encoding = PlaneEncoding::kDepthU16, .size_px = {3, 2}}};
  Bytes color = Bytes(24, 9);
  Bytes depth = {1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0};

  CollectedFrame collected() const {
    CollectedFrame frame{.format = {.number = 5, .sources = {{.layers = {layer}}}}, .planes = {}};
    frame.planes = {shared(color), shared(depth)};
    if (layer.depth_first) std::swap(frame.planes[0], frame.planes[1]);
    return frame;
  }
};

class FrameDecoderTest : public testing::Test {
 protected:
  LayerPlanes decoded(const OneLayer& frame) {
    absl::StatusOr<std::unique_ptr<Frame>> result = decoder_.decode(frame.collected());
    EXPECT_EQ(result.status(), absl::OkStatus());
    return result.ok() ? (*result)->sources.at(0).at(0) : LayerPlanes{};
  }

  BytePool pool_{8};
  FrameDecoder decoder_{pool_};
};

TEST_F(FrameDecoderTest, handsPackedPlanesOnWithoutACopy) {
  CollectedFrame collected = OneLayer().collected();
  const std::vector<SharedBytes> planes = collected.planes;
  const absl::StatusOr<std::unique_ptr<Frame>> frame = decoder_.decode(std::move(collected));
  ASSERT_TRUE(frame.ok());
  EXPECT_EQ((*frame)->format.number, 5U);
  EXPECT_EQ((*frame)->sources[0][0].color, planes[0]);
  EXPECT_EQ((*frame)->sources[0][0].depth, planes[1]);
}

TEST_F(FrameDecoderTest, findsDepthThatCameFirst) {
  OneLayer frame;
  frame.layer.depth_first = true;
  const LayerPlanes planes = decoded(frame);
  EXPECT_EQ(*planes.color, frame.color);
  EXPECT_EQ(*planes.depth, frame.depth);
}

TEST_F(FrameDecoderTest, stripsStrides) {
  OneLayer frame;
  frame.layer.depth.stride_bytes = 8;
  frame.depth = {1, 0, 2, 0, 3, 0, 77, 77, 4, 0, 5, 0, 6, 0, 77, 77};
  EXPECT_EQ(*decoded(frame).depth, (Bytes{1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0}));
}

TEST_F(FrameDecoderTest, makesRgbOpaqueRgba) {
  OneLayer frame;
  frame.layer.color.encoding = PlaneEncoding::kRgb8;
  frame.layer.color.stride_bytes = 10;
  frame.color = {1, 2, 3, 4, 5, 6, 7, 8, 9, 77, 11, 12, 13, 14, 15, 16, 17, 18, 19, 77};
  const LayerPlanes planes = decoded(frame);
  EXPECT_EQ(planes.color_encoding, PlaneEncoding::kRgba8);
  EXPECT_EQ(*planes.color, (Bytes{1,  2,  3,  255, 4,  5,  6,  255, 7,  8,  9,  255,
                                  11, 12, 13, 255, 14, 15, 16, 255, 17, 18, 19, 255}));
}

TEST_F(FrameDecoderTest, makesEveryRowOfRgbRgbaHoweverLongItIs) {
  for (uint32_t width = 1; width <= 9; ++width) {
    OneLayer frame;
    frame.layer.color.encoding = PlaneEncoding::kRgb8;
    frame.layer.color.size_px = frame.layer.depth.size_px = {width, 2};
    frame.depth = Bytes(size_t{4} * width);
    frame.color = Bytes(size_t{6} * width);
    std::iota(frame.color.begin(), frame.color.end(), uint8_t{200});
    Bytes expected;
    for (size_t i = 0; i < frame.color.size(); ++i) {
      expected.push_back(frame.color[i]);
      if (i % 3 == 2) expected.push_back(255);
    }
    EXPECT_EQ(*decoded(frame).color, expected) << width;
  }
}

TEST_F(FrameDecoderTest, keepsHalfFloatColour) {
  OneLayer frame;
  frame.layer.color.encoding = PlaneEncoding::kRgba16f;
  frame.color = Bytes(48, 3);
  const LayerPlanes planes = decoded(frame);
  EXPECT_EQ(planes.color_encoding, PlaneEncoding::kRgba16f);
  EXPECT_EQ(*planes.color, frame.color);
}

TEST_F(FrameDecoderTest, inflatesAnyPlane) {
  OneLayer frame;
  frame.layer.color.encoding = PlaneEncoding::kJpeg;
  frame.layer.color.compression = PlaneCompression::kZstd;
  frame.color = zstdFrame(sampleJpeg({3, 2}, JpegSort::kBaseline), ZstdSize::kStated);
  frame.layer.depth.compression = PlaneCompression::kZstd;
  const Bytes depth = frame.depth;
  frame.depth = zstdFrame(depth, ZstdSize::kOpen);
  const LayerPlanes planes = decoded(frame);
  EXPECT_EQ(*planes.depth, depth);
  EXPECT_EQ(planes.color->size(), 24U);
  EXPECT_EQ((*planes.color)[3], 255);
}

TEST_F(FrameDecoderTest, namesThePlaneThatIsBroken) {
  OneLayer frame;
  frame.layer.color.encoding = PlaneEncoding::kJpeg;
  frame.color = sampleJpeg({3, 2}, JpegSort::kProgressive);
  const absl::Status bad_color = decoder_.decode(frame.collected()).status();
  EXPECT_EQ(bad_color.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(fieldOf(bad_color), "header.sources[0].layers[0].planes[0]");
  EXPECT_THAT(std::string(bad_color.message()), testing::HasSubstr("progressive"));

  OneLayer other;
  other.layer.depth.compression = PlaneCompression::kZstd;
  EXPECT_EQ(fieldOf(decoder_.decode(other.collected()).status()),
            "header.sources[0].layers[0].planes[1]");
}

}  // namespace
}  // namespace viewloom::frame_decoder_test
