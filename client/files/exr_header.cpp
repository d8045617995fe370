// SPDX-License-Identifier: Apache-2.0
#include "files/exr_header.h"

#include <bit>
#include <utility>

#include "base/str_cat.h"
#include "files/byte_cursor.h"
#include "files/file_bytes.h"
#include "files/plane_image.h"

namespace viewloom::files {
namespace {

constexpr uint32_t kMagic = 20000630;
constexpr uint32_t kVersion = 2;
constexpr uint32_t kTiledFlag = 0x200, kLongNamesFlag = 0x400, kDeepFlag = 0x800;
// More than any file has; each takes several times its bytes in the file as memory.
constexpr size_t kPartsMax = 256;
constexpr size_t kChannelsMax = 1024;

bool isDeep(const ExrPart& part) {
  return part.type == "deepscanline" || part.type == "deeptile";
}

class HeaderReader {
 public:
  HeaderReader(std::string path, std::span<const uint8_t> bytes)
      : path_(std::move(path)), cursor_(bytes) {}

  absl::StatusOr<DeepExrHeader> read() {
    if (cursor_.take32() != kMagic) return refuse("begins with other bytes than an EXR file does");
    const uint32_t version = cursor_.take32();
    const uint32_t known = kTiledFlag | kLongNamesFlag | kDeepFlag | kExrMultiPartFlag | 0xFF;
    if ((version & 0xFF) != kVersion || (version & ~known) != 0) {
      return refuse(strCat("is of version ", version & 0xFF, " with flags ", version & ~0xFFU,
                           "; accepted is version 2"));
    }
    const bool is_multi_part = (version & kExrMultiPartFlag) != 0;
    std::vector<ExrPart> parts;
    VIEWLOOM_RETURN_IF_ERROR(readParts(is_multi_part, parts));
    uint64_t table_offset = cursor_.offset();
    for (uint32_t i = 0; i < parts.size(); ++i) {
      if (isDeep(parts[i])) {
        parts[i].chunk_table_offset = table_offset;
        VIEWLOOM_RETURN_IF_ERROR(check(parts[i]));
        return DeepExrHeader{is_multi_part, i, std::move(parts[i])};
      }
      // The tables of parts lie one after the other.
      const int32_t count = parts[i].chunk_count.value_or(-1);
      if (count < 0) break;
      table_offset += 8 * static_cast<uint64_t>(count);
    }
    return refuseFile(path_,
                      "has no deep part that can be found; accepted is a deep scan line or "
                      "tile part; name a flat picture without --deep");
  }

 private:
  absl::Status refuse(const std::string& problem) const {
    return refuseFile(path_, strCat("header, up to byte ", cursor_.offset(), ": ", problem));
  }

  absl::Status readParts(bool is_multi_part, std::vector<ExrPart>& parts) {
    do {
      ExrPart part;
      bool is_empty = true;
      VIEWLOOM_RETURN_IF_ERROR(readPart(part, is_empty));
      if (is_multi_part && is_empty) return absl::OkStatus();
      if (parts.size() == kPartsMax) {
        return refuse(strCat("has more than ", kPartsMax, " parts"));
      }
      parts.push_back(std::move(part));
    } while (is_multi_part);
    return absl::OkStatus();
  }

  absl::Status readPart(ExrPart& part, bool& is_empty) {
    for (;;) {
      const std::string name = cursor_.takeText();
      if (cursor_.hasFailed()) return refuse("the file ends in the header");
      if (name.empty()) return absl::OkStatus();
      is_empty = false;
      const std::string type = cursor_.takeText();
      const int32_t size = cursor_.takeSigned32();
      const auto value = cursor_.take(size < 0 ? UINT64_MAX : static_cast<uint64_t>(size));
      if (cursor_.hasFailed()) {
        return refuse(strCat("attribute ", name, " has ", size, " bytes, more than follow"));
      }
      ByteCursor content(value);
      readAttribute(name, type, content, value, part);
      if (content.hasFailed()) {
        return refuse(strCat("attribute ", name, " of ", size, " bytes ends too soon"));
      }
      if (part.channels.size() > kChannelsMax) {
        return refuse(strCat("has more than ", kChannelsMax, " channels"));
      }
    }
  }

  // Reads the known attributes, if they have the right type; others are of no use here.
  static void readAttribute(const std::string& name, const std::string& type, ByteCursor& content,
                            std::span<const uint8_t> value, ExrPart& part) {
    const auto is = [&](const char* a_name, const char* a_type) {
      return name == a_name && type == a_type;
    };
    if (is("name", "string")) part.name.assign(value.begin(), value.end());
    if (is("type", "string")) part.type.assign(value.begin(), value.end());
    if (is("compression", "compression")) part.compression = content.take8();
    if (is("dataWindow", "box2i")) part.data = takeWindow(content);
    if (is("displayWindow", "box2i")) part.display = takeWindow(content);
    if (is("chunkCount", "int")) part.chunk_count = content.takeSigned32();
    if (is("channels", "chlist")) part.channels = takeChannels(content);
    if (is("chromaticities", "chromaticities")) {
      for (float& number : part.chromaticities.emplace()) {
        number = std::bit_cast<float>(content.take32());
      }
    }
    if (is("tiles", "tiledesc")) {
      part.tile_width_px = content.take32();
      part.tile_height_px = content.take32();
    }
  }

  static ExrWindow takeWindow(ByteCursor& content) {
    ExrWindow window;
    window.min_x = content.takeSigned32();
    window.min_y = content.takeSigned32();
    window.max_x = content.takeSigned32();
    window.max_y = content.takeSigned32();
    return window;
  }

  static std::vector<ExrHeaderChannel> takeChannels(ByteCursor& content) {
    std::vector<ExrHeaderChannel> channels;
    while (!content.hasFailed() && channels.size() <= kChannelsMax) {
      ExrHeaderChannel channel{.name = content.takeText()};
      if (channel.name.empty()) break;
      channel.type = static_cast<ExrSampleType>(content.take32());
      content.take32();  // whether values are perceptual, and nothing
      const uint32_t x_sampling = content.take32();
      const uint32_t y_sampling = content.take32();
      channel.is_subsampled = x_sampling != 1 || y_sampling != 1;
      channels.push_back(std::move(channel));
    }
    return channels;
  }

  absl::Status check(const ExrPart& part) const {
    if (part.data.width() < 1 || part.data.height() < 1 || part.data.width() > kExrDataSideMax_px ||
        part.data.height() > kExrDataSideMax_px) {
      return refuse(strCat("the data window is ", part.data.width(), "x", part.data.height(),
                           " px; accepted is 1..", kExrDataSideMax_px, " a side"));
    }
    VIEWLOOM_RETURN_IF_ERROR(checkPlaneSize(path_, part.display.width(), part.display.height()));
    if (part.compression > static_cast<uint8_t>(ExrCompression::kZips)) {
      return refuse(strCat("compression is number ", part.compression,
                           "; accepted for deep data are none (0), RLE (1) and ZIPS (2)"));
    }
    const bool has_tiles = part.tile_width_px != 0 && part.tile_height_px != 0;
    if (has_tiles != (part.type == "deeptile")) {
      return refuse(strCat("is ", part.type, " with tiles of ", part.tile_width_px, "x",
                           part.tile_height_px, " px"));
    }
    for (const ExrHeaderChannel& channel : part.channels) {
      if (channel.type > ExrSampleType::kFloat || channel.is_subsampled) {
        return refuse(strCat("channel ", channel.name, " is of type ",
                             static_cast<uint32_t>(channel.type),
                             channel.is_subsampled ? ", subsampled" : "",
                             "; accepted are 0 (uint), 1 (half), 2 (float) in every px"));
      }
    }
    return checkTable(part);
  }

  absl::Status checkTable(const ExrPart& part) const {
    const int64_t chunks = part.chunkColumns() * part.chunkRows();
    if (part.chunk_count && *part.chunk_count < chunks) {
      return refuse(strCat("chunkCount is ", *part.chunk_count, "; the data window has ", chunks));
    }
    // Whatever else the file has lies behind the header, so no sum can overflow.
    const uint64_t before = part.chunk_table_offset - cursor_.offset();
    if (before > cursor_.leftCount() ||
        static_cast<uint64_t>(chunks) > (cursor_.leftCount() - before) / 8) {
      return refuse(strCat("the file has ", cursor_.leftCount(), " bytes more; ", chunks,
                           " offsets of chunks should begin after ", before));
    }
    return absl::OkStatus();
  }

  std::string path_;
  ByteCursor cursor_;
};

}  // namespace

int64_t ExrPart::chunkColumns() const {
  return tile_width_px == 0 ? 1 : (data.width() + tile_width_px - 1) / tile_width_px;
}

int64_t ExrPart::chunkRows() const {
  return tile_height_px == 0 ? data.height()
                             : (data.height() + tile_height_px - 1) / tile_height_px;
}

absl::StatusOr<DeepExrHeader> readDeepHeader(const std::string& path,
                                             std::span<const uint8_t> bytes) {
  return HeaderReader(path, bytes).read();
}

}  // namespace viewloom::files
