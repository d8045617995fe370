// SPDX-License-Identifier: Apache-2.0
// Facts that Exif states of a photo: how it is turned, and its focal length.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace viewloom::files {

// FocalLengthIn35mmFilm (tag 0xA405), mm, of a film 36 mm wide. `tiff` begins with the byte order,
// as "MM\0*". Nothing where it is absent, 0 (unknown) or out of reach.
std::optional<double> focal35mm(std::span<const uint8_t> tiff);

// Orientation (tag 0x0112), 1..8: 1 is upright, also where it is absent or out of range.
uint32_t orientationOf(std::span<const uint8_t> tiff);

// Sizes and offsets, both in bytes, of the pictures that a multi-picture index (CIPA DC-007, tag
// 0xB002) lists. Offsets count from the start of `tiff`; that of the first picture is 0.
struct PictureEntry {
  uint64_t size = 0;
  uint64_t offset = 0;
};
std::vector<PictureEntry> pictureEntries(std::span<const uint8_t> tiff);

// The TIFF bytes of an Exif item of HEIF: behind its four bytes that say how far ahead they are.
std::span<const uint8_t> tiffOfItem(std::span<const uint8_t> item);

// The TIFF bytes of Exif data that may begin with "Exif\0\0", as in JPEG.
std::span<const uint8_t> tiffOfExif(std::span<const uint8_t> exif);

}  // namespace viewloom::files
