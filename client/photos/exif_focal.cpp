// SPDX-License-Identifier: Apache-2.0
#include "photos/exif_focal.h"

#include <cstddef>

namespace viewloom::photos {
namespace {

constexpr uint64_t kExifDirectory = 0x8769;
constexpr uint64_t kFocalLengthIn35mmFilm = 0xA405;
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

 private:
  std::span<const uint8_t> bytes_;
  bool is_big_endian_;
};

}  // namespace

std::optional<double> focal35mm(std::span<const uint8_t> tiff) {
  if (tiff.size() < 8) return std::nullopt;
  const TiffNumbers numbers(tiff, tiff[0] == 'M');
  if (numbers.at(2, 2) != 42) return std::nullopt;
  const auto pointer = numbers.findEntry(numbers.at(4, 4), kExifDirectory);
  if (!pointer) return std::nullopt;
  const auto entry = numbers.findEntry(numbers.at(*pointer + 8, 4), kFocalLengthIn35mmFilm);
  if (!entry) return std::nullopt;
  const size_t value_bytes = numbers.at(*entry + 2, 2) == kShort ? 2 : 4;
  const uint64_t focal_mm = numbers.at(*entry + 8, value_bytes);
  return focal_mm > 0 ? std::optional(static_cast<double>(focal_mm)) : std::nullopt;
}

std::span<const uint8_t> tiffOfItem(std::span<const uint8_t> item) {
  if (item.size() < 4) return {};
  const uint64_t ahead = TiffNumbers(item, true).at(0, 4);
  return ahead <= item.size() - 4 ? item.subspan(4 + ahead) : std::span<const uint8_t>();
}

}  // namespace viewloom::photos
