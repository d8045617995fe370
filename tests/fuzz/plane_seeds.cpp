// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include "fuzz/seeds.h"
#include "unit/decode/h264_samples.h"
#include "unit/decode/jpeg_samples.h"
#include "unit/decode/predicted_samples.h"
#include "unit/decode/zstd_samples.h"

namespace viewloom {
namespace {

using Bytes = std::vector<uint8_t>;

Bytes joined(Bytes front, const Bytes& back) {
  front.insert(front.end(), back.begin(), back.end());
  return front;
}

// The header of a plane whose bytes come packed: the choice of frame_target.cpp, how many bytes are
// declared, no attributes.
Bytes packedPlane(uint8_t choice, size_t byte_count) {
  return {choice, static_cast<uint8_t>(byte_count >> 8), static_cast<uint8_t>(byte_count), 0};
}

// A chunk of up to 253 bytes.
Bytes chunk(const Bytes& bytes) {
  return joined({static_cast<uint8_t>(bytes.size())}, bytes);
}

}  // namespace

SeedBytes jpegSeeds() {
  SeedBytes seeds;
  for (const JpegSort sort : {JpegSort::kBaseline, JpegSort::kGrey}) {
    seeds.push_back(joined({40, 24}, sampleJpeg({40, 24}, sort)));
  }
  return seeds;
}

SeedBytes zstdSeeds() {
  Bytes content(601);
  for (size_t i = 0; i < content.size(); ++i) content[i] = static_cast<uint8_t>(i * i / 5);
  const Bytes expected{600 >> 8, 600 & 255};  // one less than the content
  return {joined(expected, zstdFrame(content, ZstdSize::kStated)),
          joined(expected, zstdFrame(content, ZstdSize::kOpen))};
}

SeedBytes predictedSeeds() {
  std::vector<uint16_t> samples(20 * 10);
  for (size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<uint16_t>(i * i * 9);
  const Bytes content = predictedBytes(samples, 20, 10);
  return {joined({19, 9}, zstdFrame(content, ZstdSize::kStated)),
          joined({19, 9}, zstdFrame(content, ZstdSize::kOpen))};
}

SeedBytes videoPlaneSeeds() {
  return {joined({24, 8}, sampleH264({40, 24})),
          joined({15, 19}, sampleH264({31, 35}, {.picture_rows = 18})),
          joined({48, 48}, sampleH264({64, 64}, {.slice_count = 2})),
          joined({16, 16}, x264Still())};
}

// Scripts of frame_target.cpp: number and sources less one; of each source its choice, width and
// height less one and layers less one; of each layer its choice, then choice and attributes of each
// plane; chunks.
SeedBytes frameSeeds() {
  const Bytes one_source{0, 0, 0, 2, 1, 0};
  // Motion, normals in the world, roughness and specular colour, of which some is not zero.
  const Bytes mirror{0, 0, 0, 2,  1, 0,  0x3c, 0,  0, 0,  0, 0,  0, 0,  1, 0,  0, 1,
                     0, 0, 0, 12, 1, 60, 2,    61, 3, 62, 4, 63, 5, 64, 6, 65, 0};
  // Two layers, the first of which begins with its depth, RGB8 and DEPTH_U16 as window depth.
  const Bytes layers{4, 0, 0, 3, 2, 1, 1, 1, 0, 2, 2, 1, 9, 0, 1, 0, 2, 2, 1, 9};
  const Bytes cube_maps{0, 1, 1, 1, 0, 0, 0x20, 0, 0, 0, 0, 0, 0, 1, 3, 0, 0, 0, 0, 0, 0, 0};
  const Bytes packed = zstdFrame(predictedBytes({1, 2, 3, 4, 5, 6}, 3, 2), ZstdSize::kStated);
  const Bytes color = zstdFrame(Bytes(24, 7), ZstdSize::kStated);
  return {{},
          mirror,
          layers,
          cube_maps,
          // RGBA8 as zstd, DEPTH_U16 predicted.
          joined(joined(joined(one_source, {0}),
                        joined(packedPlane(8, color.size()), packedPlane(2 + 16, packed.size()))),
                 joined(chunk(color), chunk(packed)))};
}

}  // namespace viewloom
