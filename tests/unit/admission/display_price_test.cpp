// SPDX-License-Identifier: Apache-2.0
#include "admission/display_price.h"

#include <gtest/gtest.h>

namespace viewloom::display_price_test {
namespace {

DisplaySpec quiltOf(uint32_t side_px) {
  DisplaySpec spec;
  spec.kind = QuiltSpec{.columns = 4, .rows = 4, .size_px = {side_px, side_px}};
  return completeDisplaySpec(spec).value();
}

TEST(DisplayPrice, growsWithThePlanesThatAreAskedFor) {
  const uint64_t area_px = 1024 * 1024;
  const DisplayPrice plain = displayPrice(quiltOf(1024), {});
  EXPECT_EQ(plain.making_bytes, 4 * area_px);
  EXPECT_EQ(plain.encoded_bytes, area_px / 2);
  const DisplayPrice all = displayPrice(quiltOf(1024), {.color = BandEncoding::kRaw,
                                                        .with_depth = true,
                                                        .with_mask = true,
                                                        .planes = BandEncoding::kRaw});
  EXPECT_EQ(all.making_bytes, 9 * area_px);
  EXPECT_EQ(all.encoded_bytes, 9 * area_px);
  EXPECT_EQ(all.viewerBytes(), kConnectionBytes + 9 * area_px);
  const DisplayPrice compact =
      displayPrice(quiltOf(1024), {.with_depth = true, .planes = BandEncoding::kCompactDepth});
  EXPECT_EQ(compact.making_bytes, 8 * area_px);
  EXPECT_EQ(compact.encoded_bytes, area_px / 2 + area_px);
}

TEST(DisplayPrice, ofOneEyeIsHalfThatOfTwo) {
  StereoSpec eyes{.eye_size_px = {640, 480}, .is_tracked = true};
  const DisplayPrice two = displayPrice(completeDisplaySpec({.kind = eyes}).value(), {});
  eyes.layout = StereoLayout::kSingle;
  const DisplayPrice one = displayPrice(completeDisplaySpec({.kind = eyes}).value(), {});
  EXPECT_EQ(2 * one.making_bytes, two.making_bytes);
  EXPECT_EQ(2 * one.rays_bytes, two.rays_bytes);
}

// 16 pictures of one view each wait, and an encoder has a few of them.
TEST(DisplayPrice, countsPicturesOfAVideoAndItsEncoder) {
  const uint64_t area_px = 1024 * 1024;
  const DisplayPrice video = displayPrice(quiltOf(1024), {.color = BandEncoding::kH264});
  EXPECT_EQ(video.making_bytes,
            4 * area_px + area_px * 3 / 2 + 10 * area_px / 16 + (uint64_t{3} << 20));
  EXPECT_EQ(video.encoded_bytes, area_px / 2);
  const EncodingSpec fine = {.color = BandEncoding::kH264, .video_qp = 20};
  EXPECT_EQ(displayPrice(quiltOf(1024), fine).encoded_bytes, area_px);
}

// 2500 views of 1x64 px lie in cells of 16x64 px.
TEST(DisplayPrice, countsTheCellsOfSmallViewsInAVideo) {
  DisplaySpec spec;
  spec.kind = QuiltSpec{.columns = 50, .rows = 50, .size_px = {50, 3200}};
  spec = completeDisplaySpec(spec).value();
  const uint64_t cells_px = uint64_t{2500} * 16 * 64;
  const DisplayPrice video =
      displayPrice(spec, {.color = BandEncoding::kH264, .with_depth = true, .video_qp = 30});
  EXPECT_GE(video.making_bytes, 8 * cells_px + cells_px * 3 / 2);
  EXPECT_GE(video.encoded_bytes, cells_px / 2 + 4 * cells_px);
}

// The encoder is there as long as the display is open.
TEST(DisplayPrice, countsTheEncoderOfChainedVideo) {
  const uint64_t area_px = 1024 * 1024;
  const EncodingSpec encoding = {.color = BandEncoding::kH264,
                                 .prediction = Prediction::kAcrossAtlases};
  const DisplayPrice chained = displayPrice(quiltOf(1024), encoding);
  const DisplayPrice alone = displayPrice(quiltOf(1024), {.color = BandEncoding::kH264});
  const uint64_t picture_px = area_px / 16;  // one view
  EXPECT_EQ(chained.chain_bytes, 10 * picture_px + (uint64_t{3} << 20));
  EXPECT_EQ(alone.chain_bytes, 0u);
  EXPECT_EQ(chained.displayBytes(), alone.displayBytes() + chained.chain_bytes);
}

TEST(DisplayPrice, countsWhatWaitsForAViewerOfChainedVideo) {
  const auto priceOf = [](uint32_t side_px, bool has_depth) {
    return displayPrice(quiltOf(side_px), {.color = BandEncoding::kH264,
                                           .with_depth = has_depth,
                                           .planes = BandEncoding::kRaw,
                                           .prediction = Prediction::kAcrossAtlases});
  };
  const uint64_t area_px = 1024 * 1024;
  EXPECT_EQ(priceOf(1024, false).queue_bytes, area_px) << "two of half a byte a pixel";
  EXPECT_EQ(priceOf(1024, true).queue_bytes, 9 * area_px);
  EXPECT_EQ(priceOf(256, false).queue_bytes, area_px / 2) << "sixteen";
  EXPECT_EQ(priceOf(1024, true).viewerBytes(), kConnectionBytes + 9 * area_px / 2 + 9 * area_px);
  EXPECT_EQ(displayPrice(quiltOf(1024), {.color = BandEncoding::kH264}).queue_bytes, 0u);
}

TEST(DisplayPrice, growsWithTheSamplesOfALens) {
  DisplaySpec spec = quiltOf(1024);
  const uint64_t sharp_bytes = displayPrice(spec, {}).rays_bytes;
  spec.lens = LensSpec{.walked_count = 64};
  EXPECT_EQ(displayPrice(spec, {}).rays_bytes, 64 * sharp_bytes);
}

TEST(AdmitDisplay, holdsTheDisplayOnceAnAtlasCouldBeMadeBesideIt) {
  MemoryBudget budget(100'000'000);
  const DisplaySpec spec = quiltOf(1024);
  const auto granted = admitDisplay(budget, spec, {}, "10.0.0.7");
  ASSERT_TRUE(granted.ok());
  EXPECT_EQ(budget.reservedBytes(MemoryUse::kDisplays), displayPrice(spec, {}).displayBytes());
}

TEST(AdmitDisplay, leavesRoomForTheFirstRungBesideTheSecond) {
  const DisplaySpec spec = quiltOf(1024);
  const EncodingSpec first = {.color = BandEncoding::kH264, .video_qp = 24, .video_qp_max = 40};
  const DisplayPrice price = displayPrice(spec, first);
  const uint64_t needed_bytes = price.displayBytes() + price.making_bytes + price.viewerBytes();
  MemoryBudget budget((needed_bytes + price.making_bytes / 2) * 4 / 3);
  EXPECT_TRUE(admitDisplay(budget, spec, first, "10.0.0.7").ok());
  EXPECT_FALSE(admitDisplay(budget, spec, onOtherRung(first), "10.0.0.7").ok());
}

TEST(AdmitDisplay, saysHowLargeAnAtlasWouldFit) {
  MemoryBudget budget(1'000'000'000);
  const EncodingSpec all{.with_depth = true, .with_mask = true, .planes = BandEncoding::kRaw};
  const auto granted = admitDisplay(budget, quiltOf(16384), all, "10.0.0.7");
  EXPECT_EQ(granted.status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(fieldOf(granted.status()), "quilt.size");
  const std::string message(granted.status().message());
  EXPECT_NE(message.find("(16 views, 16384x16384 px) takes 6.85 GB of memory; 750 MB"),
            std::string::npos)
      << message;
  EXPECT_NE(message.find("an atlas of up to 53"), std::string::npos) << message;
  EXPECT_TRUE(admitDisplay(budget, quiltOf(5300), all, "10.0.0.7").ok());
}

TEST(AdmitViewer, countsTheAtlasThatIsBeingWritten) {
  MemoryBudget budget(1'200'000);
  const DisplaySpec spec = quiltOf(1024);
  const auto first = admitViewer(budget, spec, {}, "10.0.0.7");
  ASSERT_TRUE(first.ok());
  EXPECT_EQ(budget.reservedBytes(MemoryUse::kViewers), displayPrice(spec, {}).viewerBytes());
  const auto second = admitViewer(budget, spec, {}, "10.0.0.7");
  EXPECT_EQ(second.status().code(), absl::StatusCode::kResourceExhausted);
}

}  // namespace
}  // namespace viewloom::display_price_test
