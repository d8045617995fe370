// SPDX-License-Identifier: Apache-2.0
#include "decode/jpeg_plane.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "support/large_allocations.h"
#include "unit/decode/jpeg_samples.h"

namespace viewloom::jpeg_plane_test {
namespace {

using testing::HasSubstr;

// Error in 8-bit codes of a smooth picture at quality 95 with halved chroma.
constexpr int kJpegError = 4;

class JpegPlane : public testing::Test {
 protected:
  std::string refusal(const std::vector<uint8_t>& jpeg, SizePx size_px) {
    return std::string(decoder_.decode(jpeg, size_px, out_).message());
  }

  JpegDecoder decoder_;
  std::vector<uint8_t> out_;
};

TEST_F(JpegPlane, givesBackThePictureOpaque) {
  for (const SizePx size_px : {SizePx{1, 1}, SizePx{17, 9}, SizePx{64, 48}, SizePx{8192, 3}}) {
    ASSERT_EQ(decoder_.decode(sampleJpeg(size_px, JpegSort::kBaseline), size_px, out_),
              absl::OkStatus());
    ASSERT_EQ(out_.size(), size_px.area() * 4);
    int worst = 0;
    for (uint32_t y = 0; y < size_px.height; ++y) {
      for (uint32_t x = 0; x < size_px.width; ++x) {
        uint8_t want[3];
        samplePixel(size_px, x, y, want);
        const uint8_t* got = &out_[(size_t{y} * size_px.width + x) * 4];
        for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(got[c] - want[c]));
        ASSERT_EQ(got[3], 255);
      }
    }
    EXPECT_LE(worst, kJpegError);
  }
}

TEST_F(JpegPlane, spreadsGreyOverTheColours) {
  const SizePx size_px{16, 16};
  ASSERT_TRUE(decoder_.decode(sampleJpeg(size_px, JpegSort::kGrey), size_px, out_).ok());
  uint8_t want[3];
  samplePixel(size_px, 8, 8, want);
  const uint8_t* got = &out_[(8 * 16 + 8) * 4];
  EXPECT_NEAR(got[0], want[0], kJpegError);
  EXPECT_EQ(got[1], got[0]);
  EXPECT_EQ(got[2], got[0]);
}

TEST_F(JpegPlane, refusesWhatIsNotBaseline) {
  const SizePx size_px{32, 24};
  const auto refused = [&](JpegSort sort) { return refusal(sampleJpeg(size_px, sort), size_px); };
  EXPECT_THAT(refused(JpegSort::kProgressive), HasSubstr("progressive"));
  EXPECT_THAT(refused(JpegSort::kArithmetic), HasSubstr("arithmetic"));
  EXPECT_THAT(refused(JpegSort::kCmyk), HasSubstr("CMYK"));
  EXPECT_THAT(refused(JpegSort::kRgb), HasSubstr("another colour space"));
  EXPECT_THAT(refused(JpegSort::kSeveralScans), HasSubstr("several scans"));
  EXPECT_TRUE(out_.empty());
}

TEST_F(JpegPlane, refusesTwelveBits) {
  std::vector<uint8_t> jpeg = sampleJpeg({16, 16}, JpegSort::kBaseline);
  const std::vector<uint8_t> frame_marker{0xFF, 0xC0};
  const auto marker =
      std::search(jpeg.begin(), jpeg.end(), frame_marker.begin(), frame_marker.end());
  ASSERT_NE(marker, jpeg.end());
  marker[4] = 12;  // after marker and length comes the precision
  EXPECT_THAT(refusal(jpeg, {16, 16}), HasSubstr("precision 12"));
}

TEST_F(JpegPlane, refusesAnotherSizeBeforeItAllocates) {
  EXPECT_THAT(refusal(sampleJpeg({32, 24}, JpegSort::kBaseline), {32, 25}),
              HasSubstr("JPEG has 32x24 px; accepted is the declared size, 32x25"));
  EXPECT_EQ(out_.capacity(), 0U);
}

TEST_F(JpegPlane, refusesEveryTruncation) {
  const SizePx size_px{24, 24};
  const std::vector<uint8_t> whole = sampleJpeg(size_px, JpegSort::kBaseline);
  for (size_t count = 0; count < whole.size(); ++count) {
    const std::vector<uint8_t> part(whole.begin(), whole.begin() + static_cast<long>(count));
    ASSERT_FALSE(decoder_.decode(part, size_px, out_).ok()) << count << " of " << whole.size();
  }
  EXPECT_TRUE(decoder_.decode(whole, size_px, out_).ok()) << "after so many failures";
}

TEST_F(JpegPlane, makesNoLargeAllocationOnceWarm) {
  if (!test::countsLargeAllocations()) GTEST_SKIP() << "a sanitizer owns the heap";
  const SizePx size_px{8192, 64};
  const std::vector<uint8_t> jpeg = sampleJpeg(size_px, JpegSort::kBaseline);
  const uint64_t before_warm_up = test::largeAllocationCount();
  ASSERT_TRUE(decoder_.decode(jpeg, size_px, out_).ok());
  const uint64_t before = test::largeAllocationCount();
  EXPECT_GT(before, before_warm_up) << "nothing is counted";
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(decoder_.decode(jpeg, size_px, out_).ok());
  EXPECT_EQ(test::largeAllocationCount(), before);
}

TEST_F(JpegPlane, refusesWhatIsNoJpeg) {
  EXPECT_THAT(refusal({}, {1, 1}), HasSubstr("not a whole baseline JPEG"));
  EXPECT_THAT(refusal(std::vector<uint8_t>(1000, 0xFF), {1, 1}),
              HasSubstr("not a whole baseline JPEG"));
}

}  // namespace
}  // namespace viewloom::jpeg_plane_test
