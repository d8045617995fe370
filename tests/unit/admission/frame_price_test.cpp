// SPDX-License-Identifier: Apache-2.0
#include "admission/frame_price.h"

#include <gtest/gtest.h>

#include "frame/limits.h"
#include "frame/plane_encoding.h"

namespace viewloom::frame_price_test {
namespace {

constexpr SizePx kSize_px{64, 32};
constexpr uint64_t kArea_px = 64 * 32;

PlaneFormat plane(PlaneKind kind, PlaneEncoding encoding, SizePx size_px = kSize_px) {
  PlaneFormat format{.kind = kind, .encoding = encoding, .size_px = size_px};
  format.wire_bytes = uncompressedBytes(format);
  return format;
}

PlaneFormat packed(PlaneFormat format, PlaneCompression compression, uint64_t wire_bytes) {
  format.compression = compression;
  format.wire_bytes = wire_bytes;
  return format;
}

FrameFormat frameOf(const LayerFormat& layer) {
  SourceFormat source;
  source.layers = {layer};
  return {.number = 1, .sources = {source}};
}

const PlaneFormat kColor = plane(PlaneKind::kColor, PlaneEncoding::kRgba8);
const PlaneFormat kDepth = plane(PlaneKind::kDepth, PlaneEncoding::kDepthF32);

TEST(FramePrice, countsPlanesThatAreHeldAsTheyCameOnce) {
  const FramePrice price = framePrice(frameOf({.color = kColor, .depth = kDepth}));
  EXPECT_EQ(price.receiving_bytes, 8 * kArea_px);
  EXPECT_EQ(price.decoded_bytes, 8 * kArea_px);
}

TEST(FramePrice, countsPlanesThatWidenAsTheyComeOnce) {
  const FramePrice price = framePrice(
      frameOf({.color = plane(PlaneKind::kColor, PlaneEncoding::kRgb8), .depth = kDepth}));
  EXPECT_EQ(price.receiving_bytes, 8 * kArea_px);
  EXPECT_EQ(price.decoded_bytes, 8 * kArea_px);
}

TEST(FramePrice, countsWireAndResultOfWhatIsUnpacked) {
  PlaneFormat with_gaps = plane(PlaneKind::kColor, PlaneEncoding::kRgb8);
  with_gaps.stride_bytes = 4 * kSize_px.width;
  with_gaps.wire_bytes = 4 * kArea_px;
  const FramePrice price = framePrice(
      frameOf({.color = with_gaps, .depth = packed(kDepth, PlaneCompression::kZstd, 100)}));
  EXPECT_EQ(price.receiving_bytes, 4 * kArea_px + 4 * kArea_px + 100 + 4 * kArea_px);
  EXPECT_EQ(price.decoded_bytes, 8 * kArea_px);
}

TEST(FramePrice, countsWhatZstdHoldsBetweenWireAndResult) {
  const PlaneFormat jpeg{
      .kind = PlaneKind::kColor, .encoding = PlaneEncoding::kJpeg, .size_px = kSize_px};
  const FramePrice price =
      framePrice(frameOf({.color = packed(jpeg, PlaneCompression::kZstd, 50),
                          .depth = packed(plane(PlaneKind::kDepth, PlaneEncoding::kDepthU16),
                                          PlaneCompression::kPredictedZstd, 60)}));
  const uint64_t of_color =
      50 + inflatedBytesMax(packed(jpeg, PlaneCompression::kZstd, 50)) + 4 * kArea_px;
  EXPECT_EQ(price.receiving_bytes, of_color + 60 + 2 * kArea_px + 2 * kArea_px);
  EXPECT_EQ(price.decoded_bytes, 6 * kArea_px);
}

// A decoder has one picture of a plane at a time.
TEST(FramePrice, countsWhatTheDecoderOfVideoTakes) {
  const auto video = [](SizePx size_px) {
    return PlaneFormat{.kind = PlaneKind::kColor,
                       .encoding = PlaneEncoding::kH264,
                       .size_px = size_px,
                       .wire_bytes = 1000};
  };
  const auto decoderBytes = [&](SizePx size_px) {
    const FramePrice price = framePrice(frameOf({.color = video(size_px), .depth = kDepth}));
    EXPECT_EQ(price.decoded_bytes, 4 * size_px.area() + 4 * kArea_px);
    return price.receiving_bytes - price.decoded_bytes;
  };
  EXPECT_GT(decoderBytes({16, 16}), uint64_t{4} << 20);
  EXPECT_GT(decoderBytes({1920, 1080}), uint64_t{12} * 1920 * 1080);
  EXPECT_EQ(decoderBytes({8192, 8192}), decoderBytes({8192, 1153}));
  // Pictures of a decoder have rims of 32 px.
  EXPECT_GT(decoderBytes({16384, 16}), uint64_t{9} * 16448 * 80);
  EXPECT_GT(decoderBytes({16, 16384}), uint64_t{9} * 80 * 16448);
}

TEST(FramePrice, countsTheSurfaceOfLayersThatMirror) {
  LayerFormat layer{.color = kColor, .depth = kDepth};
  layer.others = {plane(PlaneKind::kSpecular, PlaneEncoding::kR8)};
  const FramePrice price = framePrice(frameOf(layer));
  EXPECT_EQ(price.decoded_bytes, (8 + kSurfaceTexelBytes) * kArea_px);
  EXPECT_EQ(price.receiving_bytes, (9 + kSurfaceTexelBytes) * kArea_px);
}

TEST(FramePrice, isThatOfTheDeclaredSizeHoweverFewBytesCome) {
  const SizePx large_px{8192, 8192};
  SourceFormat source;
  source.layers.assign(
      2, {.color = packed(plane(PlaneKind::kColor, PlaneEncoding::kRgba8, large_px),
                          PlaneCompression::kZstd, 16500),
          .depth = packed(plane(PlaneKind::kDepth, PlaneEncoding::kDepthF32, large_px),
                          PlaneCompression::kZstd, 16500)});
  const FramePrice price = framePrice({.number = 1, .sources = {source}});
  EXPECT_EQ(price.decoded_bytes, uint64_t{8192} * 8192 * 16);
  EXPECT_EQ(price.receiving_bytes, price.decoded_bytes + 4 * 16500);
}

TEST(AdmitFrame, holdsThePlanesAloneOnceThereIsRoomForAll) {
  MemoryBudget budget(100 * kArea_px);
  const FrameFormat format = frameOf({.color = kColor, .depth = kDepth});
  const auto granted = admitFrame(
      budget, format, [](const FrameFormat&) { return 60 * kArea_px; }, "10.0.0.7");
  ASSERT_TRUE(granted.ok());
  EXPECT_EQ(granted->bytes(), 8 * kArea_px);
  EXPECT_EQ(budget.reservedBytes(MemoryUse::kFrames), 8 * kArea_px);
}

TEST(AdmitFrame, refusesWhatCannotBePreparedAndSaysWhatCan) {
  MemoryBudget budget(100 * kArea_px);
  const FrameFormat format = frameOf({.color = kColor, .depth = kDepth});
  const auto granted = admitFrame(
      budget, format, [](const FrameFormat&) { return 280 * kArea_px; }, "10.0.0.7");
  EXPECT_EQ(granted.status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(fieldOf(granted.status()), "header");
  EXPECT_EQ(granted.status().message(),
            "header: the frame (64x32 px) takes 590 kB of memory; 154 kB of the server's 205 kB "
            "(memory.budget) are left for 10.0.0.7. Such a frame fits with up to 32x16 px. For "
            "more, raise memory.budget");
  EXPECT_EQ(budget.reservedBytes(), 0u);
}

}  // namespace
}  // namespace viewloom::frame_price_test
