// SPDX-License-Identifier: Apache-2.0
#include "files/exif.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace viewloom::files {
namespace {

constexpr uint64_t kExifDirectory = 0x8769;
constexpr uint64_t kFocalLengthIn35mmFilm = 0xA405;
constexpr uint64_t kOrientation = 0x0112;
constexpr uint64_t kPictureEntries = 0xB002;
constexpr size_t kPictureEntryBytes = 16;
constexpr uint64_t kPicturesMax = 64;
constexpr uint64_t kShort = 3;
constexpr size_t kEntryBytes = 12;

// Numbers of either byte order; 0 beyond the end.
class TiffNumbers {
 public:
  TiffNumbers(std::span<const uint8_t> bytes, bool is_big_endian)
      : bytes_(bytes), is_big_endian_(is_big_endian) {}

  uint64_t at(uint64_t offset, size_t byte_count) const {
    if (offset > bytes_.size() || byte_count > bytes_.size() - offset) return 0;
    uint64_t number = 0;
    for (size_t i = 0; i < byte_count; ++i) {
      const size_t index = is_big_endian_ ? i : byte_count - 1 - i;
      number = number << 8 | bytes_[offset + index];
    }
    return number;
  }

  // Where the entry of a directory is; nothing where it has none.
  std::optional<uint64_t> findEntry(uint64_t directory, uint64_t tag) const {
    const uint64_t count = at(directory, 2);
    for (uint64_t i = 0; i < count; ++i) {
      const uint64_t entry = directory + 2 + kEntryBytes * i;
      if (entry >= bytes_.size()) return std::nullopt;
      if (at(entry, 2) == tag) return entry;
    }
    return std::nullopt;
  }

  // The number of an entry; 0 without one.
  uint64_t valueOf(std::optional<uint64_t> entry) const {
    if (!entry) return 0;
    return at(*entry + 8, at(*entry + 2, 2) == kShort ? 2 : 4);
  }

 private:
  std::span<const uint8_t> bytes_;
  bool is_big_endian_;
};

std::optional<TiffNumbers> numbersOf(std::span<const uint8_t> tiff) {
  if (tiff.size() < 8) return std::nullopt;
  const TiffNumbers numbers(tiff, tiff[0] == 'M');
  return numbers.at(2, 2) == 42 ? std::optional(numbers) : std::nullopt;
}

}  // namespace

std::optional<double> focal35mm(std::span<const uint8_t> tiff) {
  const std::optional<TiffNumbers> numbers = numbersOf(tiff);
  if (!numbers) return std::nullopt;
  const auto pointer = numbers->findEntry(numbers->at(4, 4), kExifDirectory);
  if (!pointer) return std::nullopt;
  const uint64_t focal_mm =
      numbers->valueOf(numbers->findEntry(numbers->at(*pointer + 8, 4), kFocalLengthIn35mmFilm));
  return focal_mm > 0 ? std::optional(static_cast<double>(focal_mm)) : std::nullopt;
}

uint32_t orientationOf(std::span<const uint8_t> tiff) {
  const std::optional<TiffNumbers> numbers = numbersOf(tiff);
  if (!numbers) return 1;
  const uint64_t value = numbers->valueOf(numbers->findEntry(numbers->at(4, 4), kOrientation));
  return value >= 1 && value <= 8 ? static_cast<uint32_t>(value) : 1;
}

std::vector<PictureEntry> pictureEntries(std::span<const uint8_t> tiff) {
  std::vector<PictureEntry> pictures;
  const std::optional<TiffNumbers> numbers = numbersOf(tiff);
  if (!numbers) return pictures;
  const auto entry = numbers->findEntry(numbers->at(4, 4), kPictureEntries);
  if (!entry) return pictures;
  const uint64_t count = std::min(numbers->at(*entry + 4, 4) / kPictureEntryBytes, kPicturesMax);
  const uint64_t list = numbers->at(*entry + 8, 4);
  for (uint64_t i = 0; i < count; ++i) {
    const uint64_t at = list + kPictureEntryBytes * i;
    pictures.push_back({numbers->at(at + 4, 4), numbers->at(at + 8, 4)});
  }
  return pictures;
}

std::span<const uint8_t> tiffOfExif(std::span<const uint8_t> exif) {
  constexpr std::string_view kName("Exif\0\0", 6);
  const bool has_name = exif.size() >= kName.size() &&
                        std::equal(kName.begin(), kName.end(), exif.begin(),
                                   [](char its, uint8_t c) { return uint8_t(its) == c; });
  return has_name ? exif.subspan(kName.size()) : exif;
}

std::span<const uint8_t> tiffOfItem(std::span<const uint8_t> item) {
  if (item.size() < 4) return {};
  const uint64_t ahead = TiffNumbers(item, true).at(0, 4);
  return ahead <= item.size() - 4 ? item.subspan(4 + ahead) : std::span<const uint8_t>();
}

}  // namespace viewloom::files
