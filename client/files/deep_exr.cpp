// SPDX-License-Identifier: Apache-2.0
#include "files/deep_exr.h"

#include <Imath/half.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "base/str_cat.h"
#include "files/byte_cursor.h"
#include "files/exr_layer_names.h"
#include "files/exr_unpack.h"
#include "files/file_bytes.h"
#include "files/plane_image.h"

namespace viewloom::files {

// A row or tile of the largest level. x and y count from the data window's corner.
struct DeepExr::Chunk {
  int64_t column = 0, row = 0;  // among the chunks
  int64_t x = 0, y = 0;         // px
  uint32_t width_px = 0, height_px = 0;
};

DeepExr::DeepExr(std::string path, std::vector<uint8_t> bytes, DeepExrHeader header,
                 const DeepUnits& units)
    : path_(std::move(path)), bytes_(std::move(bytes)), header_(std::move(header)), units_(units) {}

absl::StatusOr<DeepExr> DeepExr::open(const std::filesystem::path& path, const DeepUnits& units,
                                      const std::optional<ExrWindow>& window) {
  absl::StatusOr<std::vector<uint8_t>> bytes = readFileBytes(path, kDeepFileBytesMax);
  if (!bytes.ok()) return bytes.status();
  absl::StatusOr<DeepExrHeader> header = readDeepHeader(path.string(), *bytes);
  if (!header.ok()) return header.status();
  if (window) {
    VIEWLOOM_RETURN_IF_ERROR(checkPlaneSize(path.string(), window->width(), window->height()));
    header->part.display = *window;
  }
  DeepExr file(path.string(), *std::move(bytes), *std::move(header), units);
  VIEWLOOM_RETURN_IF_ERROR(file.findChannels());
  return file;
}

absl::Status DeepExr::findChannels() {
  constexpr const char* kNames[kWantedCount] = {"R", "G", "B", "A", "Z", "ZBack"};
  std::string all;
  bool is_found[kWantedCount] = {};
  for (const ExrHeaderChannel& channel : header_.part.channels) {
    for (int wanted = 0; wanted < kWantedCount; ++wanted) {
      const bool is_exact = channel.name == kNames[wanted];
      const std::string last = channel.name.substr(channel.name.rfind('.') + 1);
      const bool is_alike = !is_found[wanted] && lowered(last) == lowered(kNames[wanted]);
      if (!is_exact && !is_alike) continue;
      channels_[wanted] = {channel.type, sample_bytes_};
      is_found[wanted] = true;
    }
    sample_bytes_ += channel.sampleBytes();
    all += strCat(all.empty() ? "" : ", ", channel.name);
  }
  for (int wanted = 0; wanted < kBack; ++wanted) {
    if (is_found[wanted]) continue;
    return refuseFile(path_, strCat("has no deep channel ", kNames[wanted], "; it has ", all,
                                    "; accepted are R, G, B, A, Z and perhaps ZBack"));
  }
  if (!is_found[kBack]) channels_[kBack] = channels_[kFront];
  return absl::OkStatus();
}

absl::Status DeepExr::refuse(const Chunk& chunk, const std::string& problem) const {
  const bool has_tiles = header_.part.tile_width_px != 0;
  const std::string where = has_tiles ? strCat("tile ", chunk.column, ", ", chunk.row)
                                      : strCat("row ", chunk.row + header_.part.data.min_y);
  return refuseFile(path_, strCat(where, ": ", problem));
}

std::optional<Imf::Chromaticities> DeepExr::chromaticities() const {
  if (!header_.part.chromaticities) return std::nullopt;
  const auto& [rx, ry, gx, gy, bx, by, wx, wy] = *header_.part.chromaticities;
  return Imf::Chromaticities({rx, ry}, {gx, gy}, {bx, by}, {wx, wy});
}

bool DeepExr::isInView(const Chunk& chunk) const {
  const ExrWindow& display = header_.part.display;
  const int64_t x = chunk.x + header_.part.data.min_x;
  const int64_t y = chunk.y + header_.part.data.min_y;
  return x <= display.max_x && x + chunk.width_px > display.min_x && y <= display.max_y &&
         y + chunk.height_px > display.min_y;
}

absl::Status DeepExr::forEachRow(const std::function<void(const DeepRow&)>& visit) {
  const ExrPart& part = header_.part;
  const int64_t chunk_width_px = part.tile_width_px == 0 ? part.data.width() : part.tile_width_px;
  const int64_t chunk_height_px = part.tile_height_px == 0 ? 1 : part.tile_height_px;
  for (int64_t row = 0; row < part.chunkRows(); ++row) {
    for (int64_t column = 0; column < part.chunkColumns(); ++column) {
      Chunk chunk{column, row, column * chunk_width_px, row * chunk_height_px};
      chunk.width_px = static_cast<uint32_t>(std::min(chunk_width_px, part.data.width() - chunk.x));
      chunk.height_px =
          static_cast<uint32_t>(std::min(chunk_height_px, part.data.height() - chunk.y));
      if (isInView(chunk)) VIEWLOOM_RETURN_IF_ERROR(readChunk(chunk, visit));
    }
  }
  return absl::OkStatus();
}

absl::Status DeepExr::readChunk(const Chunk& chunk,
                                const std::function<void(const DeepRow&)>& visit) {
  const ExrPart& part = header_.part;
  const auto index = static_cast<uint64_t>(chunk.row * part.chunkColumns() + chunk.column);
  const uint64_t offset = ByteCursor(bytes_, part.chunk_table_offset + 8 * index).take64();
  ByteCursor cursor(bytes_, offset);
  const bool is_right_part = !header_.is_multi_part || cursor.take32() == header_.part_index;
  bool is_right_place = false;
  if (part.tile_width_px == 0) {
    is_right_place = cursor.takeSigned32() == chunk.y + part.data.min_y;
  } else {
    const int32_t column = cursor.takeSigned32();
    const int32_t row = cursor.takeSigned32();
    const uint64_t level = cursor.take64();  // two numbers of 32 bits
    is_right_place = column == chunk.column && row == chunk.row && level == 0;
  }
  const uint64_t table_size = cursor.take64();
  const uint64_t packed_size = cursor.take64();
  const uint64_t unpacked_size = cursor.take64();
  const auto packed_table = cursor.take(table_size);
  const auto packed = cursor.take(packed_size);
  if (cursor.hasFailed()) {
    return refuse(chunk, strCat("its chunk at byte ", offset, " ends after byte ", bytes_.size(),
                                ", the last of the file"));
  }
  if (!is_right_part || !is_right_place) {
    return refuse(chunk, strCat("the chunk at byte ", offset, " is another one"));
  }

  VIEWLOOM_RETURN_IF_ERROR(readCounts(chunk, packed_table));
  const uint64_t samples = std::accumulate(counts_.begin(), counts_.end(), uint64_t{0});
  if (unpacked_size != samples * sample_bytes_ || unpacked_size > kDeepChunkBytesMax) {
    return refuse(chunk, strCat("has ", unpacked_size, " bytes for ", samples, " samples of ",
                                sample_bytes_, "; accepted are up to ", kDeepChunkBytesMax));
  }
  sample_count_ += samples;
  if (sample_count_ > kDeepSamplesMax) {
    return refuse(chunk, strCat("is beyond ", kDeepSamplesMax, " samples in view"));
  }
  // Data that compression would not make smaller is stored uncompressed.
  const bool is_stored = packed_size == unpacked_size;
  const std::string problem = unpackExr(is_stored ? ExrCompression::kNone : compression(), packed,
                                        unpacked_size, unpacked_);
  if (!problem.empty()) return refuse(chunk, strCat("samples: ", problem));
  visitRows(chunk, visit);
  return absl::OkStatus();
}

// OpenEXR compares the table's size with that of a whole tile, also for one that ends with the
// window: it compresses where that makes it larger, and stores more than there is. Others compare
// with the tile itself.
std::string DeepExr::unpackCounts(std::span<const uint8_t> packed, uint64_t size) {
  const ExrPart& part = header_.part;
  const uint64_t whole_size =
      part.tile_width_px == 0 ? size : 4 * uint64_t{part.tile_width_px} * part.tile_height_px;
  const bool is_stored = packed.size() >= size &&
                         (compression() == ExrCompression::kNone || packed.size() >= whole_size);
  if (is_stored) return unpackExr(ExrCompression::kNone, packed.first(size), size, table_);
  const std::string problem = unpackExr(compression(), packed, size, table_);
  const bool may_be_stored = !problem.empty() && packed.size() == size;
  return may_be_stored ? unpackExr(ExrCompression::kNone, packed, size, table_) : problem;
}

// The table has, for every row, the count of samples up to and with each pixel.
absl::Status DeepExr::readCounts(const Chunk& chunk, std::span<const uint8_t> packed) {
  const uint64_t pixels = uint64_t{chunk.width_px} * chunk.height_px;
  if (pixels > kDeepChunkPixelsMax) {
    return refuse(chunk, strCat("has ", pixels, " px; accepted are up to ", kDeepChunkPixelsMax));
  }
  const std::string problem = unpackCounts(packed, 4 * pixels);
  if (!problem.empty()) return refuse(chunk, strCat("sample counts: ", problem));
  counts_.resize(pixels);
  ByteCursor cursor(table_);
  for (size_t i = 0; i < pixels; ++i) {
    const uint32_t before = i % chunk.width_px == 0 ? 0 : counts_[i - 1];
    counts_[i] = cursor.take32();
    if (counts_[i] < before || counts_[i] > kDeepSamplesMax) {
      return refuse(chunk, strCat("px ", i % chunk.width_px, " is said to end at sample ",
                                  counts_[i], ", the one before it at ", before));
    }
  }
  for (size_t i = pixels; i-- > 0;) {
    if (i % chunk.width_px != 0) counts_[i] -= counts_[i - 1];
  }
  return absl::OkStatus();
}

void DeepExr::visitRows(const Chunk& chunk, const std::function<void(const DeepRow&)>& visit) {
  const ExrWindow& data = header_.part.data;
  const ExrWindow& display = header_.part.display;
  // Columns of the chunk.
  const int64_t begin = std::max(int64_t{0}, int64_t{display.min_x} - data.min_x - chunk.x);
  const int64_t end =
      std::min(int64_t{chunk.width_px}, int64_t{display.max_x} + 1 - data.min_x - chunk.x);
  size_t bytes_begin = 0;
  for (uint32_t row = 0; row < chunk.height_px; ++row) {
    const auto counts = std::span(counts_).subspan(size_t{row} * chunk.width_px, chunk.width_px);
    const size_t row_count = std::accumulate(counts.begin(), counts.end(), size_t{0});
    const auto bytes = std::span(unpacked_).subspan(bytes_begin, row_count * sample_bytes_);
    bytes_begin += bytes.size();
    const int64_t y = chunk.y + row + data.min_y;
    if (y < display.min_y || y > display.max_y) continue;
    const auto visible =
        counts.subspan(static_cast<size_t>(begin), static_cast<size_t>(end - begin));
    const size_t first = std::accumulate(counts.begin(), counts.begin() + begin, size_t{0});
    takeSamples(bytes, row_count, first,
                std::accumulate(visible.begin(), visible.end(), size_t{0}));
    visit({.x = static_cast<uint32_t>(chunk.x + begin + data.min_x - display.min_x),
           .y = static_cast<uint32_t>(y - display.min_y),
           .counts = visible,
           .samples = samples_});
  }
}

void DeepExr::takeSamples(std::span<const uint8_t> row, size_t row_count, size_t first,
                          size_t count) {
  const auto metres = [&](Wanted wanted, size_t i) {
    return static_cast<float>(sampleAt(row, row_count, wanted, i) * units_.scale + units_.offset_m);
  };
  samples_.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const size_t at = first + i;
    samples_[i] = {
        .z_m = metres(kFront, at),
        .z_back_m = metres(kBack, at),
        .alpha = sampleAt(row, row_count, kAlpha, at),
        .color = {sampleAt(row, row_count, kRed, at), sampleAt(row, row_count, kGreen, at),
                  sampleAt(row, row_count, kBlue, at)}};
  }
}

float DeepExr::sampleAt(std::span<const uint8_t> row, size_t row_count, Wanted wanted,
                        size_t i) const {
  const Channel& channel = channels_[wanted];
  const size_t begin = row_count * channel.bytes_before;
  if (channel.type == ExrSampleType::kHalf) {
    const auto bits = static_cast<uint16_t>(row[begin + 2 * i] | row[begin + 2 * i + 1] << 8);
    return Imath::half(Imath::half::FromBits, bits);
  }
  const uint32_t bits = ByteCursor(row, begin + 4 * i).take32();
  return channel.type == ExrSampleType::kUint ? static_cast<float>(bits)
                                              : std::bit_cast<float>(bits);
}

}  // namespace viewloom::files
