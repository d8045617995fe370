// SPDX-License-Identifier: Apache-2.0
// Pictures in containers, byte by byte or by the libraries that write them.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

namespace viewloom::files {

// The bytes of numbers, in the order of the machine (little endian).
template <typename Number>
std::string rawBytes(std::initializer_list<Number> numbers) {
  std::string bytes;
  for (const Number number : numbers) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof(Number));
  }
  return bytes;
}

// A TIFF header and one directory whose only entry is Orientation.
std::string exifOrientation(uint16_t orientation);

// Quality 100 without subsampling, `rgb` of [height][width][3]; Exif in APP1 where there is any.
std::string writtenJpeg(int width_px, int height_px, const std::vector<uint8_t>& rgb,
                        const std::string& exif = "");

struct PngChunks {
  std::string exif;
  double gamma = 0;          // gAMA; 0 = none
  bool has_srgb = false;     // sRGB
  bool has_p3_chrm = false;  // cHRM of Display P3
};
// 8 or 16 bits; samples of 16 bits big endian.
std::string writtenPng(uint32_t width_px, uint32_t height_px, int color_type, int bits,
                       const std::vector<uint8_t>& samples, const PngChunks& chunks = {});

// Lossless, with an EXIF chunk where there is any.
std::string writtenWebp(int width_px, int height_px, const std::vector<uint8_t>& rgb,
                        const std::string& exif = "");

struct WrittenTiff {
  uint32_t width_px = 0, height_px = 0;
  uint16_t channels = 1, bits = 8;
  uint16_t format = 1;       // SAMPLEFORMAT_UINT
  uint16_t photometric = 1;  // MINISBLACK
  uint16_t compression = 1, predictor = 1, planar = 1, orientation = 1;
  uint32_t tile_px = 0;    // 0 = strips of two rows
  std::string mode = "w";  // "wb" big endian, "w8" BigTIFF
};
// samples: as they lie in memory, [height][width][channels].
std::string writtenTiff(const std::string& path, const WrittenTiff& how,
                        const std::string& samples);

// A header of numpy and the samples. `shape` as Python writes it: "(2, 3)".
std::string writtenNpy(const std::string& type, const std::string& shape,
                       const std::string& samples, bool is_fortran = false, int version = 1);

}  // namespace viewloom::files
