// SPDX-License-Identifier: Apache-2.0
// Makes colour planes in H.264, for tests that read them.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "frame/size.h"

namespace viewloom {

// Options of a plane; each picture but the last has so many rows.
struct H264Sample {
  uint32_t picture_rows = 4096;
  uint32_t slice_count = 1;
  uint32_t qp = 22;
};

// The picture of samplePixel (jpeg_samples.h).
std::vector<uint8_t> sampleH264(SizePx size_px, const H264Sample& sample = {});

// The same picture, as one that refers to the picture before it: a P picture alone.
std::vector<uint8_t> dependentH264(SizePx size_px);

// Bytes of hexadecimal digits.
std::vector<uint8_t> bytesOfHex(std::string_view digits);

// Pictures of 32x32 px by x264, with the options that their names say.
std::vector<uint8_t> x264Still();         // high profile, full range, BT.601
std::vector<uint8_t> x264LimitedRange();  // as ffmpeg makes it by default
std::vector<uint8_t> x264BPictures();     // I, P and two B pictures
std::vector<uint8_t> x264FullChroma();    // 4:4:4

}  // namespace viewloom
