// SPDX-License-Identifier: Apache-2.0
// Deep OpenEXR files: the samples of every pixel.
#pragma once

#include <OpenEXR/ImfChromaticities.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/status.h"
#include "deep/deep_sample.h"
#include "files/exr_header.h"

namespace viewloom::files {

// Limits, each checked before memory is taken. Windows are within kSideMax_px (the display's) and
// kExrDataSideMax_px.
inline constexpr uint64_t kDeepFileBytesMax = uint64_t{1} << 32;
// Limits for the visible part:
inline constexpr uint64_t kDeepChunkPixelsMax = uint64_t{1} << 26;  // in a tile or row
inline constexpr uint64_t kDeepChunkBytesMax = uint64_t{1} << 28;   // its samples, unpacked
inline constexpr uint64_t kDeepSamplesMax = uint64_t{1} << 29;      // in the file

// Metres = Z of the file * scale + offset.
struct DeepUnits {
  double scale = 1;
  double offset_m = 0;
};

// Some pixels of a row of the window, side by side.
struct DeepRow {
  uint32_t x = 0;  // of the first pixel
  uint32_t y = 0;
  std::span<const uint32_t> counts;           // samples of each pixel
  std::span<const deep::DeepSample> samples;  // of one pixel after the other, in no order
};

// A deep scan line or tile part: R, G, B, A and Z, and ZBack where samples have thickness, in any
// case and behind any layer's name, each of any type, uncompressed or as RLE or ZIPS. Of several
// parts the first deep one counts; of several levels, the largest.
class DeepExr {
 public:
  // `window`: the px to read, in the file's own; none = its display window.
  static absl::StatusOr<DeepExr> open(const std::filesystem::path& path, const DeepUnits& units,
                                      const std::optional<ExrWindow>& window = {});

  uint32_t widthPx() const { return static_cast<uint32_t>(header_.part.display.width()); }
  uint32_t heightPx() const { return static_cast<uint32_t>(header_.part.display.height()); }
  std::optional<Imf::Chromaticities> chromaticities() const;

  // Visits all pixels of the window that the file has samples for, in any order, in pieces
  // of rows. Stops with what is wrong, and where, when a chunk is not as it must be.
  absl::Status forEachRow(const std::function<void(const DeepRow&)>& visit);

 private:
  struct Chunk;
  // Where a channel lies among the samples of a row, in bytes a sample.
  struct Channel {
    ExrSampleType type = ExrSampleType::kHalf;
    uint32_t bytes_before = 0;
  };
  enum Wanted { kRed, kGreen, kBlue, kAlpha, kFront, kBack, kWantedCount };

  DeepExr(std::string path, std::vector<uint8_t> bytes, DeepExrHeader header,
          const DeepUnits& units);
  absl::Status findChannels();
  bool isInView(const Chunk& chunk) const;
  absl::Status readChunk(const Chunk& chunk, const std::function<void(const DeepRow&)>& visit);
  ExrCompression compression() const {
    return static_cast<ExrCompression>(header_.part.compression);
  }
  std::string unpackCounts(std::span<const uint8_t> packed, uint64_t size);
  absl::Status readCounts(const Chunk& chunk, std::span<const uint8_t> packed);
  absl::Status refuse(const Chunk& chunk, const std::string& problem) const;
  void visitRows(const Chunk& chunk, const std::function<void(const DeepRow&)>& visit);
  void takeSamples(std::span<const uint8_t> row, size_t row_count, size_t first, size_t count);
  float sampleAt(std::span<const uint8_t> row, size_t row_count, Wanted wanted, size_t i) const;

  std::string path_;
  std::vector<uint8_t> bytes_;
  DeepExrHeader header_;
  DeepUnits units_;
  Channel channels_[kWantedCount];
  uint32_t sample_bytes_ = 0;  // of all channels of the file
  uint64_t sample_count_ = 0;  // so far
  // Sizes of one chunk, kept for the next.
  std::vector<uint8_t> table_;
  std::vector<uint32_t> counts_;
  std::vector<uint8_t> unpacked_;
  std::vector<deep::DeepSample> samples_;
};

}  // namespace viewloom::files
