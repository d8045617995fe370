// SPDX-License-Identifier: Apache-2.0
#include "unit/decode/jpeg_samples.h"

#include <algorithm>
#include <array>
#include <cstdio>  // jpeglib.h needs FILE
#include <cstdlib>

#include <jpeglib.h>

namespace viewloom {
namespace {

constexpr int kQuality = 95;

// One scan per channel, as baseline allows.
constexpr std::array<jpeg_scan_info, 3> kScanPerChannel{{
    {1, {0}, 0, 63, 0, 0},
    {1, {1}, 0, 63, 0, 0},
    {1, {2}, 0, 63, 0, 0},
}};

int channelCount(JpegSort sort) {
  return sort == JpegSort::kGrey ? 1 : sort == JpegSort::kCmyk ? 4 : 3;
}

void choose(jpeg_compress_struct& encoder, JpegSort sort) {
  const int channels = channelCount(sort);
  encoder.input_components = channels;
  encoder.in_color_space = channels == 1 ? JCS_GRAYSCALE : channels == 4 ? JCS_CMYK : JCS_RGB;
  jpeg_set_defaults(&encoder);
  jpeg_set_quality(&encoder, kQuality, TRUE);
  if (sort == JpegSort::kProgressive) jpeg_simple_progression(&encoder);
  if (sort == JpegSort::kArithmetic) encoder.arith_code = TRUE;
  if (sort == JpegSort::kRgb) jpeg_set_colorspace(&encoder, JCS_RGB);
  if (sort == JpegSort::kSeveralScans) {
    encoder.scan_info = kScanPerChannel.data();
    encoder.num_scans = static_cast<int>(kScanPerChannel.size());
  }
}

}  // namespace

void samplePixel(SizePx size_px, uint32_t x, uint32_t y, uint8_t rgb[3]) {
  // Less than a level from pixel to pixel, whatever the size.
  const uint32_t width_px = std::max(size_px.width, 256U);
  const uint32_t height_px = std::max(size_px.height, 256U);
  rgb[0] = static_cast<uint8_t>(40 + 160 * x / width_px);
  rgb[1] = static_cast<uint8_t>(30 + 180 * y / height_px);
  rgb[2] = static_cast<uint8_t>(200 - 120 * x / width_px);
}

std::vector<uint8_t> sampleJpeg(SizePx size_px, JpegSort sort) {
  jpeg_compress_struct encoder;
  jpeg_error_mgr errors;
  encoder.err = jpeg_std_error(&errors);
  jpeg_create_compress(&encoder);
  unsigned char* bytes = nullptr;
  unsigned long count = 0;
  jpeg_mem_dest(&encoder, &bytes, &count);
  encoder.image_width = size_px.width;
  encoder.image_height = size_px.height;
  choose(encoder, sort);
  jpeg_start_compress(&encoder, TRUE);
  std::vector<uint8_t> row;
  for (uint32_t y = 0; y < size_px.height; ++y) {
    row.clear();
    for (uint32_t x = 0; x < size_px.width; ++x) {
      uint8_t pixel[4] = {0, 0, 0, 0};
      samplePixel(size_px, x, y, pixel);
      row.insert(row.end(), pixel, pixel + encoder.input_components);
    }
    JSAMPROW rows[] = {row.data()};
    jpeg_write_scanlines(&encoder, rows, 1);
  }
  jpeg_finish_compress(&encoder);
  jpeg_destroy_compress(&encoder);
  std::vector<uint8_t> jpeg(bytes, bytes + count);
  std::free(bytes);
  return jpeg;
}

}  // namespace viewloom
