// SPDX-License-Identifier: Apache-2.0
#include "files/picture_file.h"

#include <array>
#include <bit>
#include <cstdlib>
#include <vector>

#include "base/str_cat.h"
#include "files/byte_cursor.h"
#include "files/file_bytes.h"

namespace viewloom::files {
namespace {

constexpr uint32_t kInfoBytes = 40, kInfoBytesMax = 124;
constexpr uint32_t kPlain = 0, kMasks = 3, kMasksWithAlpha = 6;

struct BmpHeader {
  uint32_t pixels_offset = 0;
  int64_t width_px = 0, height_px = 0;  // height below 0: top row first
  uint32_t bits = 0, compression = 0, palette_count = 0;
  size_t palette_offset = 0;
  std::array<uint32_t, 4> masks{0x00FF0000, 0x0000FF00, 0x000000FF, 0};  // red, green, blue, alpha
};

uint32_t take16(ByteCursor& cursor) {
  const uint32_t low = cursor.take8();
  return low | uint32_t{cursor.take8()} << 8;
}

absl::StatusOr<BmpHeader> parseHeader(const std::string& name, std::span<const uint8_t> bytes) {
  ByteCursor cursor(bytes, 10);
  BmpHeader header;
  header.pixels_offset = cursor.take32();
  const uint32_t info_bytes = cursor.take32();
  header.width_px = cursor.takeSigned32();
  header.height_px = cursor.takeSigned32();
  take16(cursor);  // planes
  header.bits = take16(cursor);
  header.compression = cursor.take32();
  cursor.take(12);  // size, resolution
  header.palette_count = cursor.take32();
  cursor.take32();
  if (cursor.hasFailed()) return refuseCutShort(name, "BMP");
  if (info_bytes < kInfoBytes || info_bytes > kInfoBytesMax) {
    return refuseDamaged(name, "BMP", strCat("a header of ", info_bytes, " bytes"));
  }
  const bool has_masks = header.compression == kMasks || header.compression == kMasksWithAlpha;
  if (has_masks) {
    const bool has_alpha = info_bytes > 52 || header.compression == kMasksWithAlpha;
    for (size_t i = 0; i < (has_alpha ? 4U : 3U); ++i) header.masks[i] = cursor.take32();
  } else if (header.bits == 16) {
    header.masks = {0x7C00, 0x03E0, 0x001F, 0};
  }
  header.palette_offset = size_t{14} + info_bytes;
  const bool is_known =
      (header.bits == 8 && header.compression == kPlain) ||
      (header.bits == 24 && header.compression == kPlain) ||
      ((header.bits == 16 || header.bits == 32) && (header.compression == kPlain || has_masks));
  if (!is_known) {
    return refuseFile(
        name, strCat("is a BMP of ", header.bits, " bits a px and compression ", header.compression,
                     "; accepted are 8, 16, 24 and 32 bits without "
                     "compression: save it as PNG"));
  }
  VIEWLOOM_RETURN_IF_ERROR(checkPlaneSize(name, header.width_px, std::abs(header.height_px)));
  return header;
}

// The bits of a mask as 0..255.
uint8_t maskedCode(uint32_t pixel, uint32_t mask) {
  if (mask == 0) return 255;
  const int shift = std::countr_zero(mask);
  const uint32_t most = mask >> shift;
  return static_cast<uint8_t>((uint64_t{(pixel & mask) >> shift} * 255 + most / 2) / most);
}

using Palette = std::array<std::array<uint8_t, 3>, 256>;

absl::StatusOr<Palette> readPalette(const std::string& name, const BmpHeader& header,
                                    std::span<const uint8_t> bytes) {
  const uint32_t count = header.palette_count == 0 ? 256 : header.palette_count;
  if (count > 256) return refuseDamaged(name, "BMP", "a palette of more than 256 colours");
  Palette palette{};
  ByteCursor cursor(bytes, header.palette_offset);
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t bgr = cursor.take32();
    palette[i] = {uint8_t(bgr >> 16), uint8_t(bgr >> 8), uint8_t(bgr)};
  }
  if (cursor.hasFailed()) return refuseCutShort(name, "BMP");
  return palette;
}

bool isGrey(const Palette& palette) {
  for (const auto& [red, green, blue] : palette) {
    if (red != green || green != blue) return false;
  }
  return true;
}

}  // namespace

absl::StatusOr<Picture> decodeBmp(const std::string& name, std::span<const uint8_t> bytes) {
  const absl::StatusOr<BmpHeader> header = parseHeader(name, bytes);
  if (!header.ok()) return header.status();
  absl::StatusOr<Palette> palette = Palette{};
  if (header->bits == 8) palette = readPalette(name, *header, bytes);
  if (!palette.ok()) return palette.status();
  const bool is_grey = header->bits == 8 && isGrey(*palette);
  Picture picture{.width_px = static_cast<uint32_t>(header->width_px),
                  .height_px = static_cast<uint32_t>(std::abs(header->height_px)),
                  .channels = is_grey                 ? 1U
                              : header->masks[3] != 0 ? 4U
                                                      : 3U,
                  .bits = 8,
                  .coding = {},
                  .bytes = {}};
  const size_t stored_bytes = header->bits / 8;
  const size_t row_bytes = (stored_bytes * picture.width_px + 3) / 4 * 4;
  ByteCursor cursor(bytes, header->pixels_offset);
  const auto rows = cursor.take(row_bytes * picture.height_px);
  if (cursor.hasFailed()) return refuseCutShort(name, "BMP");
  picture.bytes.reserve(picture.pixelCount() * picture.channels);
  for (size_t y = 0; y < picture.height_px; ++y) {
    for (size_t x = 0; x < picture.width_px; ++x) {
      const auto stored = rows.subspan(y * row_bytes + x * stored_bytes, stored_bytes);
      uint32_t pixel = 0;
      for (size_t i = 0; i < stored_bytes; ++i) pixel |= uint32_t{stored[i]} << (8 * i);
      for (size_t i = 0; i < picture.channels; ++i) {
        picture.bytes.push_back(header->bits == 8 ? (*palette)[pixel][i]
                                                  : maskedCode(pixel, header->masks[i]));
      }
    }
  }
  if (header->height_px > 0) flipRows(picture.bytes, picture.height_px);
  return picture;
}

}  // namespace viewloom::files
