// SPDX-License-Identifier: Apache-2.0
#include "files/picture_file.h"

#include <array>
#include <optional>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "base/str_cat.h"
#include "files/byte_cursor.h"
#include "files/file_bytes.h"
#include "files/stored_samples.h"

namespace viewloom::files {
namespace {

constexpr size_t kMagicBytes = 6;
constexpr size_t kHeaderBytesMax = 1 << 16;
constexpr size_t kDimensionsMax = 6;

// The literal behind a key of the header's dictionary, up to where the value ends.
std::string valueOf(const std::string& header, const char* key, char last) {
  for (const char quote : {'\'', '"'}) {
    const std::string quoted = strCat(std::string(1, quote), key, std::string(1, quote));
    const size_t at = header.find(quoted);
    if (at == std::string::npos) continue;
    const size_t colon = header.find(':', at + quoted.size());
    if (colon == std::string::npos) continue;
    const size_t end = header.find(last, colon);
    if (end == std::string::npos) continue;
    return std::string(
        absl::StripAsciiWhitespace(absl::string_view(header).substr(colon + 1, end - colon - 1)));
  }
  return "";
}

// Reads types such as "<f4": byte order, kind, bytes.
std::optional<SampleType> typeOf(std::string text) {
  if (text.size() < 2 || (text.front() != '\'' && text.front() != '"')) return std::nullopt;
  text = text.substr(1, text.size() - 2);
  SampleType type;
  if (!text.empty() && (text[0] == '<' || text[0] == '>' || text[0] == '|' || text[0] == '=')) {
    type.is_big_endian = text[0] == '>';
    text.erase(0, 1);
  }
  if (text.size() != 2) return std::nullopt;
  type.bytes = static_cast<uint32_t>(text[1] - '0');
  type.kind = text[0] == 'f'   ? NumberKind::kFloat
              : text[0] == 'i' ? NumberKind::kSigned
                               : NumberKind::kUnsigned;
  const bool is_size = type.bytes == 1 || type.bytes == 2 || type.bytes == 4 || type.bytes == 8;
  const bool is_known = text[0] == 'i' || text[0] == 'u' || (text[0] == 'f' && type.bytes > 1);
  return is_size && is_known ? std::optional(type) : std::nullopt;
}

std::optional<std::vector<int64_t>> shapeOf(std::string text) {
  if (text.empty() || text.front() != '(') return std::nullopt;
  std::vector<int64_t> shape;
  for (const auto part : absl::StrSplit(text.substr(1), ',')) {
    const auto word = absl::StripAsciiWhitespace(part);
    if (word.empty()) continue;
    int64_t side = 0;
    if (!absl::SimpleAtoi(word, &side) || side < 0 || shape.size() == kDimensionsMax) {
      return std::nullopt;
    }
    shape.push_back(side);
  }
  return shape;
}

// Where the samples of a picture lie in an array: steps are counted in samples.
struct Layout {
  int64_t height_px = 0, width_px = 0, channels = 1;
  size_t row_step = 0, column_step = 0, channel_step = 0;
};

std::optional<Layout> layoutOf(std::vector<int64_t> shape, bool is_fortran) {
  std::vector<size_t> steps(shape.size());
  size_t step = 1;
  for (size_t i = 0; i < shape.size(); ++i) {
    const size_t axis = is_fortran ? i : shape.size() - 1 - i;
    steps[axis] = step;
    if (shape[axis] > 4 * kSideMax_px) return std::nullopt;
    step *= static_cast<size_t>(shape[axis]);
  }
  while (shape.size() > 3 && shape.front() == 1) {
    shape.erase(shape.begin());
    steps.erase(steps.begin());
  }
  if (shape.size() == 2) return Layout{shape[0], shape[1], 1, steps[0], steps[1], 0};
  if (shape.size() != 3) return std::nullopt;
  if (shape[2] >= 1 && shape[2] <= 4) {
    return Layout{shape[0], shape[1], shape[2], steps[0], steps[1], steps[2]};
  }
  if (shape[0] < 1 || shape[0] > 4) return std::nullopt;
  return Layout{shape[1], shape[2], shape[0], steps[1], steps[2], steps[0]};
}

absl::StatusOr<std::string> takeHeader(const std::string& name, ByteCursor& cursor) {
  cursor.take(kMagicBytes);
  const uint8_t version = cursor.take8();
  cursor.take8();
  uint64_t length = cursor.take8();
  length |= uint64_t{cursor.take8()} << 8;
  if (version > 1) {
    length |= uint64_t{cursor.take8()} << 16;
    length |= uint64_t{cursor.take8()} << 24;
  }
  if (version < 1 || version > 3 || length > kHeaderBytesMax) {
    return refuseDamaged(name, "NPY", "its header is none of version 1, 2 or 3");
  }
  const auto header = cursor.take(length);
  if (cursor.hasFailed()) return refuseCutShort(name, "NPY");
  return std::string(header.begin(), header.end());
}

}  // namespace

absl::StatusOr<Picture> decodeNpy(const std::string& name, std::span<const uint8_t> bytes) {
  ByteCursor cursor(bytes);
  const absl::StatusOr<std::string> header = takeHeader(name, cursor);
  if (!header.ok()) return header.status();
  const std::string stated_type = valueOf(*header, "descr", ',');
  const std::optional<SampleType> type = typeOf(stated_type);
  const std::string stated_shape = valueOf(*header, "shape", ')');
  const auto shape = shapeOf(stated_shape);
  if (!type) {
    return refuseFile(name, strCat("holds ", stated_type.substr(0, 40),
                                   "; accepted are floats of 16, 32 and 64 bits and whole "
                                   "numbers: save array.astype('float32')"));
  }
  const auto layout =
      shape ? layoutOf(*shape, valueOf(*header, "fortran_order", ',') == "True") : std::nullopt;
  if (!layout) {
    return refuseFile(name, strCat("is an array of shape ", stated_shape.substr(0, 60),
                                   "); accepted are (height, width) and (height, width, "
                                   "channels): save one frame of it"));
  }
  VIEWLOOM_RETURN_IF_ERROR(checkPlaneSize(name, layout->width_px, layout->height_px));
  Picture picture{.width_px = static_cast<uint32_t>(layout->width_px),
                  .height_px = static_cast<uint32_t>(layout->height_px),
                  .channels = static_cast<uint32_t>(layout->channels),
                  .bits = pictureBits(*type),
                  .coding = {},
                  .bytes = {}};
  const auto samples = cursor.take(picture.pixelCount() * picture.channels * type->bytes);
  if (cursor.hasFailed()) return refuseCutShort(name, "NPY");
  picture.bytes.resize(picture.pixelCount() * picture.pixelBytes());
  size_t index = 0;
  for (size_t y = 0; y < picture.height_px; ++y) {
    for (size_t x = 0; x < picture.width_px; ++x) {
      for (size_t channel = 0; channel < picture.channels; ++channel) {
        const size_t at =
            y * layout->row_step + x * layout->column_step + channel * layout->channel_step;
        storeSample(&samples[at * type->bytes], *type, picture, index++);
      }
    }
  }
  return picture;
}

}  // namespace viewloom::files
