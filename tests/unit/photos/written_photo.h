// SPDX-License-Identifier: Apache-2.0
// Portrait photos as an iPhone writes them: HEVC images in HEIF, a colour one with Exif and a
// colour profile, an auxiliary grey one with Apple's XMP.
#pragma once

#include <libheif/heif.h>

#include <array>
#include <filesystem>
#include <functional>
#include <string>

#include "unit/photos/auxiliary_boxes.h"

namespace viewloom::test {

// Coded without loss. Colour is subsampled (4:2:0): only colours that 16x16 px share come through.
struct WrittenPhoto {
  // Below 64 px a side libheif makes the image a tile of a grid.
  uint32_t width_px = 192;
  uint32_t height_px = 144;
  std::function<std::array<uint8_t, 3>(uint32_t x, uint32_t y)> color;
  Bytes icc;                // empty = none
  int nclx_primaries = 2;   // H.273; 2 = unspecified
  uint16_t focal_35mm = 0;  // 0 = no Exif

  bool has_second = true;
  uint32_t second_width_px = 96;
  uint32_t second_height_px = 72;
  int second_bits = 8;
  std::function<uint16_t(uint32_t x, uint32_t y)> code;
  std::string second_type = "urn:mpeg:hevc:2015:auxid:2";
  Bytes subtypes;
  std::string xmp;

  heif_orientation orientation = heif_orientation_normal;  // of both
};

// A portrait photo whose colours are those of blockColor, different in neighbouring blocks of 16x16
// px, and whose codes are those of secondCode.
WrittenPhoto portrait();
std::array<uint8_t, 3> blockColor(uint32_t x, uint32_t y);
uint16_t secondCode(uint32_t x, uint32_t y);

// Apple's XMP, with the properties as elements.
std::string appleXmp(const std::string& type, const std::string& float_min,
                     const std::string& float_max);

// A profile with these colorants: rXYZ, gXYZ, bXYZ.
Bytes iccProfile(const std::array<std::array<double, 3>, 3>& colorants);

// The depth representation information of ITU-T H.265, annex G, as auxC holds it. `ends`: Z near
// and far, or, when is_disparity, the least and the largest disparity.
Bytes depthRepresentation(uint32_t type, bool is_disparity, const std::array<double, 2>& ends);

Bytes encodePhoto(const WrittenPhoto& photo);
void writePhoto(const std::filesystem::path& path, const WrittenPhoto& photo);
void writeBytes(const std::filesystem::path& path, const Bytes& bytes);

}  // namespace viewloom::test
