// SPDX-License-Identifier: Apache-2.0
// Judged by the conversion of libjpeg-turbo; the formulas that shaders take, too.
#include "sweep/ycbcr_kernels.h"

#include <random>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "shared/ycbcr.h"
#include "support/ycbcr_planes.h"

namespace viewloom::test::ycbcr_kernels_test {
namespace {

using Bytes = std::vector<uint8_t>;

// Every colour once, above it some that the encoders ignore.
constexpr SizePx kAllColors_px{4096, 4096};

std::vector<uint32_t> allColors() {
  std::vector<uint32_t> colors(kAllColors_px.area());
  for (uint32_t i = 0; i < colors.size(); ++i) colors[i] = i | i << 24;
  return colors;
}

std::vector<uint32_t> randomPicture(SizePx size_px) {
  std::mt19937 random(7);
  std::vector<uint32_t> rgbx(size_px.area());
  for (uint32_t& px : rgbx) px = uint32_t(random());
  return rgbx;
}

template <typename Formula>
uint32_t apply(Formula formula, uint32_t rgbx) {
  return formula(float(rgbx & 0xff), float(rgbx >> 8 & 0xff), float(rgbx >> 16 & 0xff));
}

Bytes convert(const std::vector<uint32_t>& rgbx, SizePx size_px, ColorForm form) {
  const YcbcrLayout layout(size_px, form);
  Bytes planes(layout.sizeBytes());
  uint8_t* luma = planes.data();
  uint8_t* cb = planes.data() + layout.cbOffset();
  uint8_t* cr = planes.data() + layout.crOffset();
  for (uint32_t y = 0; y < layout.chroma_row_count; ++y) {
    if (form == ColorForm::kYcbcr444) {
      ycbcrRow444(&rgbx[y * size_px.width], size_px.width, luma, cb, cr);
      luma += layout.luma_stride;
    } else {
      const uint32_t* upper = &rgbx[2 * y * size_px.width];
      ycbcrRows420({.upper_rgba = upper,
                    .lower_rgba = upper + size_px.width,
                    .upper_luma = luma,
                    .lower_luma = luma + layout.luma_stride,
                    .cb = cb,
                    .cr = cr},
                   size_px.width);
      luma += 2 * layout.luma_stride;
    }
    cb += layout.chroma_stride;
    cr += layout.chroma_stride;
  }
  return planes;
}

// The kernels of every kind of CPU that this one can stand for.
template <typename Check>
void onEachKindOfCpu(const Check& check) {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    check();
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(YcbcrKernels, convertEveryColourAsLibjpegDoes) {
  const std::vector<uint32_t> colors = allColors();
  const Bytes expected = ycbcrPlanesOf(colors, kAllColors_px, ColorForm::kYcbcr444);
  onEachKindOfCpu(
      [&] { EXPECT_TRUE(convert(colors, kAllColors_px, ColorForm::kYcbcr444) == expected); });
}

TEST(YcbcrKernels, averageChromaAsLibjpegDoes) {
  for (const SizePx size_px :
       {SizePx{32, 2}, SizePx{64, 100}, SizePx{992, 64}, SizePx{4096, 512}}) {
    const std::vector<uint32_t> picture = randomPicture(size_px);
    const Bytes expected = ycbcrPlanesOf(picture, size_px, ColorForm::kYcbcr420);
    onEachKindOfCpu(
        [&] { EXPECT_TRUE(convert(picture, size_px, ColorForm::kYcbcr420) == expected); });
  }
}

TEST(Ycbcr, formulasConvertEveryColourAsLibjpegDoes) {
  const Bytes expected = ycbcrPlanesOf(allColors(), kAllColors_px, ColorForm::kYcbcr444);
  const size_t count = kAllColors_px.area();
  size_t differ_count = 0;
  for (uint32_t rgb = 0; rgb < count; ++rgb) {
    differ_count += apply(abi::lumaOf, rgb) != expected[rgb] ||
                    apply(abi::cbOf, rgb) != expected[count + rgb] ||
                    apply(abi::crOf, rgb) != expected[2 * count + rgb];
  }
  EXPECT_EQ(differ_count, 0U);
}

TEST(Ycbcr, formulasAverageChromaAsLibjpegDoes) {
  constexpr SizePx kSize_px{256, 256};
  const std::vector<uint32_t> picture = randomPicture(kSize_px);
  const YcbcrLayout layout(kSize_px, ColorForm::kYcbcr420);
  const Bytes expected = ycbcrPlanesOf(picture, kSize_px, ColorForm::kYcbcr420);
  for (uint32_t y = 0; y < layout.chroma_row_count; ++y) {
    for (uint32_t x = 0; x < layout.chroma_stride; ++x) {
      const uint32_t* px = &picture[2 * (y * kSize_px.width + x)];
      const auto mean = [&](auto of) {
        return abi::meanChroma(apply(of, px[0]) + apply(of, px[1]) + apply(of, px[kSize_px.width]) +
                                   apply(of, px[kSize_px.width + 1]),
                               x);
      };
      const size_t at = size_t{y} * layout.chroma_stride + x;
      ASSERT_EQ(mean(abi::cbOf), expected[layout.cbOffset() + at]);
      ASSERT_EQ(mean(abi::crOf), expected[layout.crOffset() + at]);
    }
  }
}

}  // namespace
}  // namespace viewloom::test::ycbcr_kernels_test
