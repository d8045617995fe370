// SPDX-License-Identifier: Apache-2.0
#include "lib/compress_frame.h"

#include <zstd.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <utility>

#include "base/check.h"

namespace viewloom {
namespace {

constexpr size_t kSampleBytes = sizeof(uint16_t);

// 0, -1, 1, -2, ... to 0, 1, 2, 3, ..., modulo 65536.
uint16_t zigzag(uint16_t difference) {
  const uint32_t wide = difference;
  return static_cast<uint16_t>((wide << 1) ^ (0U - (wide >> 15)));
}

}  // namespace

std::vector<uint8_t> predictPlane(std::span<const uint8_t> samples, uint32_t width_px,
                                  uint32_t height_px) {
  const size_t width = width_px;
  const size_t area = width * height_px;
  VIEWLOOM_CHECK(samples.size() == area * kSampleBytes);
  std::vector<uint8_t> out(samples.size());
  // With a 0 to the left of each row: the compiler can then work on many px at once.
  std::vector<uint16_t> above(width + 1);
  std::vector<uint16_t> row(width + 1);
  for (size_t y = 0; y < height_px; ++y) {
    std::memcpy(&row[1], &samples[y * width * kSampleBytes], width * kSampleBytes);
    uint8_t* low = &out[y * width];
    uint8_t* high = low + area;
    for (size_t x = 0; x < width; ++x) {
      const uint16_t z =
          zigzag(static_cast<uint16_t>(row[x + 1] - row[x] - above[x + 1] + above[x]));
      low[x] = static_cast<uint8_t>(z);
      high[x] = static_cast<uint8_t>(z >> 8);
    }
    above.swap(row);
  }
  return out;
}

namespace {

constexpr int kDepthLevel = 1;  // of depth, when nothing else is asked for: higher ones gain little

// `bytes` become `content`, packed, if that is smaller.
void pack(const std::vector<uint8_t>& content, int level, v1::PlaneCompression compression,
          v1::Plane& plane, SharedBytes& bytes) {
  std::vector<uint8_t> out(ZSTD_compressBound(content.size()));
  const size_t size = ZSTD_compress(out.data(), out.size(), content.data(), content.size(), level);
  VIEWLOOM_CHECK(ZSTD_isError(size) == 0);  // the bound leaves room for any input
  if (size >= bytes->size()) return;
  out.resize(size);
  plane.set_compression(compression);
  plane.set_bytes_count(size);
  bytes = std::make_shared<const std::vector<uint8_t>>(std::move(out));
}

bool canPredict(const v1::Plane& plane, const SharedBytes& bytes) {
  const bool has_16_bits = plane.encoding() == v1::PLANE_ENCODING_DEPTH_U16 ||
                           plane.encoding() == v1::PLANE_ENCODING_DEPTH_F16;
  return has_16_bits && plane.stride_bytes() == 0 &&
         bytes->size() == size_t{2} * plane.size().width() * plane.size().height();
}

void compressPlane(const CompressionOptions& options, v1::Plane& plane, SharedBytes& bytes) {
  const bool packed = plane.compression() > v1::PLANE_COMPRESSION_NONE ||
                      plane.encoding() == v1::PLANE_ENCODING_JPEG ||
                      plane.encoding() == v1::PLANE_ENCODING_H264;
  if (packed) return;
  const bool is_for_depth = options.predicts_depth && plane.kind() == v1::PLANE_KIND_DEPTH;
  const int level = is_for_depth ? std::max(options.zstd_level, kDepthLevel) : options.zstd_level;
  if (level == 0) return;
  if (is_for_depth && canPredict(plane, bytes)) {
    pack(predictPlane(*bytes, plane.size().width(), plane.size().height()), level,
         v1::PLANE_COMPRESSION_PREDICTED_ZSTD, plane, bytes);
  } else {
    pack(*bytes, level, v1::PLANE_COMPRESSION_ZSTD, plane, bytes);
  }
}

size_t planeCount(const v1::Source& source) {
  size_t count = 0;
  for (const v1::Layer& layer : source.layers()) count += static_cast<size_t>(layer.planes_size());
  return count;
}

}  // namespace

CompressedFrame compressFrame(WireFrame frame, const CompressionOptions& options) {
  CompressedFrame compressed{.frame = std::move(frame), .depth = {}};
  std::span<SharedBytes> planes = compressed.frame.planes;
  for (v1::Source& source : *compressed.frame.header.mutable_sources()) {
    if (options.predicts_depth) compressed.depth.push_back(quantiseDepth(source, planes));
    size_t index = 0;
    for (v1::Layer& layer : *source.mutable_layers()) {
      for (v1::Plane& plane : *layer.mutable_planes()) {
        compressPlane(options, plane, planes[index++]);
      }
    }
    planes = planes.subspan(planeCount(source));
  }
  return compressed;
}

}  // namespace viewloom
