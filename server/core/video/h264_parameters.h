// SPDX-License-Identifier: Apache-2.0
// Parameters of an H.264 stream: its sequence parameter set, levels and codec string.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "base/status.h"
#include "frame/size.h"

namespace viewloom {

// Colour of a stream, as numbers of ITU-T H.264, tables E-3 to E-5.
struct H264Color {
  bool is_full_range = false;
  uint8_t primaries = 2;  // 2 = not said
  uint8_t transfer = 2;
  uint8_t matrix = 2;

  bool operator==(const H264Color&) const = default;
};

// Facts from a sequence parameter set (7.3.2.1.1 and annex E).
struct H264Parameters {
  uint8_t profile = 0;           // profile_idc: 66 baseline, 77 main, 100 high
  uint8_t constraints = 0;       // the byte of constraint flags
  uint8_t level = 0;             // ten times the level
  SizePx size_px;                // cropped
  uint32_t reference_count = 0;  // most pictures that one may refer to (max_num_ref_frames)
  H264Color color;
  std::optional<uint32_t> reorder_count;  // max_num_reorder_frames; empty = not said
};

// Colour of all videos that viewloom makes: that of shared/ycbcr.h in sRGB.
inline constexpr H264Color kVideoColor = {
    .is_full_range = true, .primaries = 1, .transfer = 13, .matrix = 6};

// Profile of all videos that viewloom makes, and its constraint flags, as OpenH264 writes them: no
// fields, no pictures that refer to later ones.
inline constexpr uint8_t kMainProfile = 77;
inline constexpr uint8_t kVideoConstraints = 0x4C;

// Level 5.1. Larger numbers ask for more of a decoder.
inline constexpr uint32_t kH264LevelMax = 51;

// Reads a sequence parameter set, from its type byte on, of any bytes. Only 4:2:0 of 8 bits,
// without fields. INVALID_ARGUMENT otherwise.
absl::StatusOr<H264Parameters> parseH264Parameters(std::span<const uint8_t> unit);

// Parameters of the first set in an Annex B stream of any bytes. INVALID_ARGUMENT if there is none.
absl::StatusOr<H264Parameters> h264ParametersOf(std::span<const uint8_t> stream);

// Ten times the lowest level with pictures of this size (table A-1). Expects a size within level
// 6. Rates are not considered, as nobody knows them before.
uint32_t h264Level(SizePx size_px);

// Codec of the streams that encoders of viewloom make for such pictures: main profile.
std::string codedVideoString(SizePx size_px);

// Codec of a stream, as WebCodecs and RFC 6381 write it: "avc1.42C020".
std::string h264CodecString(const H264Parameters& parameters);

}  // namespace viewloom
