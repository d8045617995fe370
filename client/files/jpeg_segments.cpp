// SPDX-License-Identifier: Apache-2.0
#include "files/jpeg_segments.h"

#include <algorithm>
#include <map>
#include <string_view>

#include "files/exif.h"

namespace viewloom::files {
namespace {

using std::string_view_literals::operator""sv;

constexpr uint8_t kStartOfScan = 0xDA, kEndOfImage = 0xD9, kApp1 = 0xE1, kApp2 = 0xE2;
constexpr std::string_view kXmp = "http://ns.adobe.com/xap/1.0/\0"sv;
constexpr std::string_view kExtendedXmp = "http://ns.adobe.com/xmp/extension/\0"sv;
constexpr size_t kGuidBytes = 32;
// Depth in extended XMP takes a few MB.
constexpr uint64_t kExtendedXmpBytesMax = uint64_t{64} << 20;

uint64_t bigEndian(std::span<const uint8_t> bytes) {
  uint64_t number = 0;
  for (const uint8_t byte : bytes) number = number << 8 | byte;
  return number;
}

bool begins(std::span<const uint8_t> bytes, std::string_view with) {
  return bytes.size() >= with.size() &&
         std::equal(with.begin(), with.end(), bytes.begin(),
                    [](char its, uint8_t byte) { return uint8_t(its) == byte; });
}

std::string textOf(std::span<const uint8_t> bytes) {
  return {bytes.begin(), bytes.end()};
}

class SegmentReader {
 public:
  explicit SegmentReader(std::span<const uint8_t> bytes) : bytes_(bytes) {}

  JpegSegments read() {
    size_t at = 2;  // after SOI
    while (at + 4 <= bytes_.size() && bytes_[at] == 0xFF) {
      const uint8_t marker = bytes_[at + 1];
      if (marker == 0xFF) {  // fill
        ++at;
        continue;
      }
      if (marker == kEndOfImage) break;
      const size_t length = bigEndian(bytes_.subspan(at + 2, 2));
      if (length < 2 || length > bytes_.size() - at - 2) return std::move(found_);
      take(marker, bytes_.subspan(at + 4, length - 2), at + 4);
      at += 2 + length;
      if (marker == kStartOfScan) at = endOfScan(at);
    }
    if (at + 2 <= bytes_.size() && bytes_[at] == 0xFF && bytes_[at + 1] == kEndOfImage) {
      found_.end = at + 2;
    }
    for (const auto& [number, part] : icc_) {
      found_.icc.insert(found_.icc.end(), part.begin(), part.end());
    }
    return std::move(found_);
  }

 private:
  void take(uint8_t marker, std::span<const uint8_t> body, size_t offset) {
    const bool is_table = marker == 0xC4 || marker == 0xC8 || marker == 0xCC;
    if (marker >= 0xC0 && marker <= 0xCF && !is_table) found_.frame_marker = marker;
    if (marker == kStartOfScan) ++found_.scan_count;
    if (marker == kApp1) takeApp1(body);
    if (marker == kApp2 && begins(body, "ICC_PROFILE\0"sv) && body.size() > 14) {
      icc_[body[12]] = body.subspan(14);
    }
    if (marker == kApp2 && begins(body, "MPF\0"sv) && found_.mpf_offset == 0) {
      found_.mpf = body.subspan(4);
      found_.mpf_offset = offset + 4;
    }
  }

  void takeApp1(std::span<const uint8_t> body) {
    if (begins(body, "Exif\0\0"sv) && found_.exif.empty()) found_.exif = tiffOfExif(body);
    if (begins(body, kXmp) && found_.xmp.empty()) found_.xmp = textOf(body.subspan(kXmp.size()));
    const size_t head = kExtendedXmp.size() + kGuidBytes;
    if (!begins(body, kExtendedXmp) || body.size() < head + 8) return;
    const uint64_t size = bigEndian(body.subspan(head, 4));
    const uint64_t offset = bigEndian(body.subspan(head + 4, 4));
    const auto part = body.subspan(head + 8);
    // No more than the file can hold, whatever it says.
    if (size > std::min<uint64_t>(kExtendedXmpBytesMax, bytes_.size())) return;
    if (offset > size || part.size() > size - offset) return;
    if (found_.extended_xmp.size() < size) found_.extended_xmp.resize(size);
    std::copy(part.begin(), part.end(),
              found_.extended_xmp.begin() + static_cast<std::ptrdiff_t>(offset));
  }

  // The marker behind coded samples: in these, 0xFF is followed by 0, or by a restart's number.
  size_t endOfScan(size_t at) const {
    for (; at + 1 < bytes_.size(); ++at) {
      if (bytes_[at] != 0xFF) continue;
      const uint8_t next = bytes_[at + 1];
      if (next != 0 && next != 0xFF && !(next >= 0xD0 && next <= 0xD7)) return at;
    }
    return bytes_.size();
  }

  std::span<const uint8_t> bytes_;
  JpegSegments found_;
  std::map<uint8_t, std::span<const uint8_t>> icc_;
};

}  // namespace

JpegSegments readJpegSegments(std::span<const uint8_t> bytes) {
  return SegmentReader(bytes).read();
}

std::vector<std::span<const uint8_t>> otherPictures(std::span<const uint8_t> bytes,
                                                    const JpegSegments& segments) {
  std::vector<std::span<const uint8_t>> pictures;
  // Each entry: attributes, size, offset (from the index) of 4 bytes, two numbers of 2.
  for (const auto& [size, offset] : pictureEntries(segments.mpf)) {
    if (offset == 0) continue;  // the first picture
    const uint64_t begin = segments.mpf_offset + offset;
    if (begin >= bytes.size() || size > bytes.size() - begin || size < 4) continue;
    const auto picture = bytes.subspan(begin, size);
    if (begins(picture, "\xff\xd8"sv)) pictures.push_back(picture);
  }
  return pictures;
}

}  // namespace viewloom::files
