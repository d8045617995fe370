// SPDX-License-Identifier: Apache-2.0
#include "encode/quilt_exif.h"

#include <string>
#include <string_view>

#include "display/quilt_json.h"

namespace viewloom {
namespace {

using namespace std::string_view_literals;

// Tags and types of Exif 2.32 (CIPA DC-008), sections 4.6.2 to 4.6.5.
constexpr uint16_t kExifIfdTag = 0x8769;
constexpr uint16_t kExifVersionTag = 0x9000;
constexpr uint16_t kUserCommentTag = 0x9286;
constexpr uint16_t kLongType = 4;
constexpr uint16_t kUndefinedType = 7;
constexpr uint32_t kExifVersion = 0x30323332;  // "0232"

constexpr uint16_t kApp1Marker = 0xFFE1;
constexpr size_t kLength_bytes = 2;  // a segment's length counts itself, not its marker
constexpr std::string_view kExifCode = "Exif\0\0"sv;
constexpr std::string_view kAsciiCode = "ASCII\0\0\0"sv;  // how a UserComment's text is coded

// Offsets count from the TIFF header. A directory is a count, 12 bytes an entry, and the offset of
// the next.
constexpr uint32_t directoryBytes(uint32_t entry_count) {
  return 2 + 12 * entry_count + 4;
}
constexpr uint32_t kFirstDirectory = 8;
constexpr uint32_t kExifDirectory = kFirstDirectory + directoryBytes(1);
constexpr uint32_t kUserComment = kExifDirectory + directoryBytes(2);

// Big-endian, as JPEG itself.
class TiffBytes {
 public:
  void add16(size_t value) {
    bytes_.push_back(static_cast<uint8_t>(value >> 8));
    bytes_.push_back(static_cast<uint8_t>(value));
  }
  void add32(size_t value) {
    add16(value >> 16);
    add16(value & 0xFFFF);
  }
  void addText(std::string_view text) { bytes_.insert(bytes_.end(), text.begin(), text.end()); }
  // `value`: of up to four bytes, or its offset.
  void addEntry(uint16_t tag, uint16_t type, size_t count, uint32_t value) {
    add16(tag);
    add16(type);
    add32(count);
    add32(value);
  }
  std::vector<uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<uint8_t> bytes_;
};

}  // namespace

std::vector<uint8_t> quiltExif(const AtlasLayout& layout) {
  if (layout.suffix.empty()) return {};
  const std::string json = quiltJson({.view_count = uint32_t(layout.views.size()),
                                      .columns = layout.columns,
                                      .rows = layout.rows,
                                      .aspect = layout.aspect});
  const size_t comment_bytes = kAsciiCode.size() + json.size();
  TiffBytes segment;
  segment.add16(kApp1Marker);
  segment.add16(kLength_bytes + kExifCode.size() + kUserComment + comment_bytes);
  segment.addText(kExifCode);
  segment.addText("MM\0\x2A"sv);
  segment.add32(kFirstDirectory);
  segment.add16(1);
  segment.addEntry(kExifIfdTag, kLongType, 1, kExifDirectory);
  segment.add32(0);
  segment.add16(2);
  segment.addEntry(kExifVersionTag, kUndefinedType, sizeof(kExifVersion), kExifVersion);
  segment.addEntry(kUserCommentTag, kUndefinedType, comment_bytes, kUserComment);
  segment.add32(0);
  segment.addText(kAsciiCode);
  segment.addText(json);
  return segment.take();
}

}  // namespace viewloom
