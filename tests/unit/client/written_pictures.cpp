// SPDX-License-Identifier: Apache-2.0
#include "unit/client/written_pictures.h"

#include <gtest/gtest.h>
#include <png.h>
#include <tiffio.h>
#include <turbojpeg.h>
#include <webp/encode.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "unit/client/test_files.h"

namespace viewloom::files {
namespace {

std::string bigEndian(uint32_t number, int byte_count) {
  std::string bytes;
  for (int i = byte_count - 1; i >= 0; --i) bytes += static_cast<char>(number >> (8 * i));
  return bytes;
}

std::string pngChunk(const std::string& name, const std::string& body) {
  const std::string content = name + body;
  const uLong crc =
      crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
  return bigEndian(static_cast<uint32_t>(body.size()), 4) + content +
         bigEndian(static_cast<uint32_t>(crc), 4);
}

// PNG counts in 1 / 100000.
std::string parts(double number) {
  return bigEndian(static_cast<uint32_t>(std::lround(100000 * number)), 4);
}

void appendBytes(png_structp png, png_bytep bytes, png_size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<char*>(bytes), count);
}

// A chunk of RIFF, padded to an even length.
std::string riffChunk(const std::string& name, std::string body) {
  const auto size = static_cast<uint32_t>(body.size());
  if (body.size() % 2 != 0) body += '\0';
  return name + rawBytes({size}) + body;
}

// Regroups interleaved samples: planes one by one, or tiles.
std::string blockOf(const WrittenTiff& how, const std::string& samples, uint32_t x0, uint32_t y0,
                    uint32_t width, uint32_t height, int plane) {
  const size_t sample_bytes = how.bits / 8U;
  const uint32_t first = plane < 0 ? 0 : static_cast<uint32_t>(plane);
  const uint32_t count = plane < 0 ? how.channels : 1U;
  std::string block;
  for (uint32_t y = y0; y < y0 + height; ++y) {
    for (uint32_t x = x0; x < x0 + width; ++x) {
      for (uint32_t channel = first; channel < first + count; ++channel) {
        const uint32_t inside_x = std::min(x, how.width_px - 1);
        const uint32_t inside_y = std::min(y, how.height_px - 1);
        const size_t index = (size_t{inside_y} * how.width_px + inside_x) * how.channels + channel;
        block += samples.substr(index * sample_bytes, sample_bytes);
      }
    }
  }
  return block;
}

}  // namespace

std::string exifOrientation(uint16_t orientation) {
  return std::string("MM\0*\0\0\0\x08\0\x01", 10) + bigEndian(0x0112, 2) + bigEndian(3, 2) +
         bigEndian(1, 4) + bigEndian(orientation, 2) + std::string(6, '\0');
}

std::string writtenJpeg(int width_px, int height_px, const std::vector<uint8_t>& rgb,
                        const std::string& exif) {
  tjhandle handle = tjInitCompress();
  unsigned char* out = nullptr;
  unsigned long size = 0;
  EXPECT_EQ(tjCompress2(handle, rgb.data(), width_px, 0, height_px, TJPF_RGB, &out, &size,
                        TJSAMP_444, 100, 0),
            0);
  std::string bytes(reinterpret_cast<char*>(out), size);
  tjFree(out);
  tjDestroy(handle);
  if (exif.empty()) return bytes;
  const std::string body = std::string("Exif\0\0", 6) + exif;
  const std::string segment =
      "\xff\xe1" + bigEndian(static_cast<uint32_t>(body.size() + 2), 2) + body;
  return bytes.insert(2, segment);
}

std::string writtenPng(uint32_t width_px, uint32_t height_px, int color_type, int bits,
                       const std::vector<uint8_t>& samples, const PngChunks& chunks) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &bytes, &appendBytes, nullptr);
  png_set_IHDR(png, info, width_px, height_px, bits, color_type, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  const size_t row_bytes = png_get_rowbytes(png, info);
  std::vector<uint8_t> copy = samples;
  for (size_t y = 0; y < height_px; ++y) png_write_row(png, &copy[row_bytes * y]);
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  std::string told;
  if (!chunks.exif.empty()) told += pngChunk("eXIf", chunks.exif);
  if (chunks.has_srgb) told += pngChunk("sRGB", std::string(1, '\0'));
  if (chunks.gamma > 0) told += pngChunk("gAMA", parts(chunks.gamma));
  if (chunks.has_p3_chrm) {
    std::string xy;
    for (const double share : {0.3127, 0.329, 0.68, 0.32, 0.265, 0.69, 0.15, 0.06}) {
      xy += parts(share);
    }
    told += pngChunk("cHRM", xy);
  }
  constexpr size_t kHeaderBytes = 33;  // signature and IHDR
  return bytes.insert(kHeaderBytes, told);
}

std::string writtenWebp(int width_px, int height_px, const std::vector<uint8_t>& rgb,
                        const std::string& exif) {
  uint8_t* out = nullptr;
  const size_t size = WebPEncodeLosslessRGB(rgb.data(), width_px, height_px, 3 * width_px, &out);
  std::string bytes(reinterpret_cast<char*>(out), size);
  WebPFree(out);
  if (exif.empty()) return bytes;
  // The extended form: canvas and flags first, EXIF last.
  const std::string canvas = rawBytes({uint32_t{8}}) +
                             rawBytes({uint32_t(width_px - 1)}).substr(0, 3) +
                             rawBytes({uint32_t(height_px - 1)}).substr(0, 3);
  const std::string body =
      "WEBP" + riffChunk("VP8X", canvas) + bytes.substr(12) + riffChunk("EXIF", exif);
  return riffChunk("RIFF", body);
}

std::string writtenTiff(const std::string& path, const WrittenTiff& how,
                        const std::string& samples) {
  TIFF* tiff = TIFFOpen(path.c_str(), how.mode.c_str());
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, how.width_px);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, how.height_px);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, how.channels);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, how.bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, how.format);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, how.photometric);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, how.compression);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, how.planar);
  TIFFSetField(tiff, TIFFTAG_ORIENTATION, how.orientation);
  if (how.predictor != 1) TIFFSetField(tiff, TIFFTAG_PREDICTOR, how.predictor);
  const bool is_tiled = how.tile_px != 0;
  const uint32_t width = is_tiled ? how.tile_px : how.width_px;
  const uint32_t height = is_tiled ? how.tile_px : 2;
  if (is_tiled) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, width);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, height);
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, height);
  }
  const bool is_apart = how.planar == PLANARCONFIG_SEPARATE;
  for (uint16_t plane = 0; plane < (is_apart ? how.channels : 1); ++plane) {
    for (uint32_t y = 0; y < how.height_px; y += height) {
      for (uint32_t x = 0; x < how.width_px; x += width) {
        const uint32_t rows = is_tiled ? height : std::min(height, how.height_px - y);
        std::string block = blockOf(how, samples, x, y, width, rows, is_apart ? plane : -1);
        const auto size = static_cast<tmsize_t>(block.size());
        if (is_tiled) {
          TIFFWriteEncodedTile(tiff, TIFFComputeTile(tiff, x, y, 0, plane), block.data(), size);
        } else {
          TIFFWriteEncodedStrip(tiff, TIFFComputeStrip(tiff, y, plane), block.data(), size);
        }
      }
    }
  }
  TIFFClose(tiff);
  return bytesOf(path);
}

std::string writtenNpy(const std::string& type, const std::string& shape,
                       const std::string& samples, bool is_fortran, int version) {
  std::string header = "{'descr': '" + type +
                       "', 'fortran_order': " + (is_fortran ? "True" : "False") +
                       ", 'shape': " + shape + ", }";
  while ((header.size() + 11) % 64 != 0) header += ' ';
  header += '\n';
  const auto length = static_cast<uint32_t>(header.size());
  const std::string length_bytes = rawBytes({length}).substr(0, version == 1 ? 2 : 4);
  return std::string("\x93NUMPY") + static_cast<char>(version) + '\0' + length_bytes + header +
         samples;
}

}  // namespace viewloom::files
