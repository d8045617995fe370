// SPDX-License-Identifier: Apache-2.0
// Bands of Y'CbCr are judged by what libjpeg makes of the same picture in RGB.
#include <gtest/gtest.h>

#include "encode/band_encoder.h"
#include "support/ycbcr_planes.h"
#include "unit/encode/picture.h"

namespace viewloom::test::planar_bands_test {
namespace {

// The planes of a picture, and bands of them.
struct PlanarPicture {
  SizePx size_px;
  ColorForm form;
  Bytes planes;

  PlanarPicture(const Picture& picture, ColorForm color_form)
      : size_px(picture.size_px),
        form(color_form),
        planes(ycbcrPlanesOf(std::span(picture.rgbx), picture.stride_bytes, size_px, form)) {}

  BandPixels band(uint32_t first_row, uint32_t row_count) const {
    return rowsOf(planarPixels(planes, size_px, form), first_row, row_count);
  }
};

const std::vector<SizePx> kSizes = {{1, 1},     {2, 2},     {17, 100}, {15, 15},   {64, 128},
                                    {199, 129}, {333, 257}, {96, 700}, {40, 1301}, {1282, 390}};

TEST(BandEncoder, makesTheSameJpegOfPlanesAsOfRgb) {
  BytePool pool(4);
  BandEncoder encoder(pool);
  for (const SizePx size_px : kSizes) {
    const Picture picture(size_px);
    for (const Chroma chroma : {Chroma::k420, Chroma::k444}) {
      for (const uint32_t quality : {1u, 85u, 100u}) {
        const EncodingSpec encoding = {.jpeg_quality = quality, .chroma = chroma};
        const PlanarPicture planar(picture, directForm(encoding));
        const uint32_t band_rows = bandRowCount(encoding);
        for (uint32_t row = 0; row < size_px.height; row += band_rows) {
          const uint32_t row_count = std::min(band_rows, size_px.height - row);
          const AtlasLayout layout = layoutOf(size_px);
          ASSERT_EQ(*encoder.encode(planar.band(row, row_count), encoding, layout).bytes,
                    *encoder.encode(picture.band(row, row_count), encoding, layout).bytes)
              << size_px.width << "x" << size_px.height << " from row " << row << ", quality "
              << quality;
        }
      }
    }
  }
}

TEST(BandEncoder, takesThePlanesOfItsOwnChromaAlone) {
  BytePool pool(4);
  BandEncoder encoder(pool);
  const PlanarPicture planar(Picture({64, 64}), ColorForm::kYcbcr444);
  const BandPixels band = planar.band(0, 64);
  const AtlasLayout layout = layoutOf({64, 64});
  EXPECT_DEATH(encoder.encode(band, {.chroma = Chroma::k420}, layout), "directForm");
  EXPECT_DEATH(encoder.encode(band, {.color = BandEncoding::kRaw}, layout), "directForm");
}

}  // namespace
}  // namespace viewloom::test::planar_bands_test
