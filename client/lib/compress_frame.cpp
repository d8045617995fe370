// SPDX-License-Identifier: Apache-2.0
#include "lib/compress_frame.h"

#include <zstd.h>

#include <memory>
#include <utility>

#include "base/check.h"

namespace viewloom {
namespace {

void compressPlane(v1::Plane& plane, SharedBytes& bytes, int level) {
  const bool packed = plane.compression() == v1::PLANE_COMPRESSION_ZSTD ||
                      plane.encoding() == v1::PLANE_ENCODING_JPEG;
  if (packed) return;
  std::vector<uint8_t> out(ZSTD_compressBound(bytes->size()));
  const size_t size = ZSTD_compress(out.data(), out.size(), bytes->data(), bytes->size(), level);
  VIEWLOOM_CHECK(ZSTD_isError(size) == 0);  // the bound leaves room for any input
  if (size >= bytes->size()) return;
  out.resize(size);
  plane.set_compression(v1::PLANE_COMPRESSION_ZSTD);
  plane.set_bytes_count(size);
  bytes = std::make_shared<const std::vector<uint8_t>>(std::move(out));
}

}  // namespace

WireFrame compressFrame(WireFrame frame, int level) {
  size_t index = 0;
  for (v1::Source& source : *frame.header.mutable_sources()) {
    for (v1::Layer& layer : *source.mutable_layers()) {
      for (v1::Plane& plane : *layer.mutable_planes()) {
        compressPlane(plane, frame.planes[index++], level);
      }
    }
  }
  return frame;
}

}  // namespace viewloom
