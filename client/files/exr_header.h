// SPDX-License-Identifier: Apache-2.0
// Headers of OpenEXR files, read here and not by the library: deep files then need nothing of it
// that trusts their bytes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/status.h"

namespace viewloom::files {

// Limit for the sides of a data window: far beyond any display window, while the number of chunks
// stays bounded.
inline constexpr int64_t kExrDataSideMax_px = 32768;
// In the version field: headers of several parts follow each other.
inline constexpr uint32_t kExrMultiPartFlag = 0x1000;

// The last column and row belong to it.
struct ExrWindow {
  int32_t min_x = 0, min_y = 0, max_x = -1, max_y = -1;

  int64_t width() const { return int64_t{max_x} - min_x + 1; }
  int64_t height() const { return int64_t{max_y} - min_y + 1; }
};

// Numbers as in files.
enum class ExrSampleType : uint32_t { kUint = 0, kHalf = 1, kFloat = 2 };
enum class ExrCompression : uint8_t { kNone = 0, kRle = 1, kZips = 2 };

struct ExrHeaderChannel {
  std::string name;
  ExrSampleType type = ExrSampleType::kHalf;
  bool is_subsampled = false;

  uint32_t sampleBytes() const { return type == ExrSampleType::kHalf ? 2 : 4; }
};

struct ExrPart {
  std::string name;  // "" = none
  std::string type;  // "deepscanline", "deeptile", "scanlineimage", "tiledimage"; "" = not said
  uint8_t compression = 0;
  ExrWindow data;
  ExrWindow display;
  std::vector<ExrHeaderChannel> channels;  // in the order in which chunks have them
  uint32_t tile_width_px = 0;              // 0 = no tiles
  uint32_t tile_height_px = 0;
  std::optional<int32_t> chunk_count;
  // x and y of red, green, blue and white, as in the file.
  std::optional<std::array<float, 8>> chromaticities;
  uint64_t chunk_table_offset = 0;  // where in the file the offsets of its chunks begin

  // Chunk columns of the largest level.
  int64_t chunkColumns() const;
  int64_t chunkRows() const;
};

// The first deep part of a file.
struct DeepExrHeader {
  bool is_multi_part = false;
  uint32_t part_index = 0;
  ExrPart part;
};

// The header is checked. Both windows have an inside and are within the limits; the compression is
// one of ExrCompression. Tiles have a size (no tiles: one row a chunk), and no channel is
// subsampled. The table of the largest level's chunks lies in the file.
absl::StatusOr<DeepExrHeader> readDeepHeader(const std::string& path,
                                             std::span<const uint8_t> bytes);

}  // namespace viewloom::files
