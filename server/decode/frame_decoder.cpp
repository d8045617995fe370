// SPDX-License-Identifier: Apache-2.0
#include "decode/frame_decoder.h"

#include <utility>

#include "base/check.h"
#include "base/str_cat.h"
#include "decode/raw_plane.h"
#include "frame/limits.h"

namespace viewloom {

absl::StatusOr<SharedBytes> FrameDecoder::inflatePlane(const PlaneFormat& plane,
                                                       const SharedBytes& wire) {
  const absl::StatusOr<uint64_t> content_bytes =
      plane.encoding == PlaneEncoding::kJpeg
          ? ZstdInflater::contentBytesUpTo(*wire, jpegBytesMax(plane.size_px.area()))
          : ZstdInflater::contentBytes(*wire, uncompressedBytes(plane));
  if (!content_bytes.ok()) return content_bytes.status();
  BytePool::Buffer inflated = pool_.take(*content_bytes);
  VIEWLOOM_RETURN_IF_ERROR(zstd_.inflate(*wire, *content_bytes, *inflated));
  return SharedBytes(std::move(inflated));
}

absl::StatusOr<SharedBytes> FrameDecoder::decodePlane(const PlaneFormat& plane, SharedBytes wire) {
  if (plane.compression == PlaneCompression::kZstd) {
    absl::StatusOr<SharedBytes> inflated = inflatePlane(plane, wire);
    if (!inflated.ok()) return inflated.status();
    wire = *std::move(inflated);
  }
  if (isPacked(plane)) return wire;
  BytePool::Buffer packed = pool_.take(decodedBytes(plane));
  if (plane.encoding == PlaneEncoding::kJpeg) {
    VIEWLOOM_RETURN_IF_ERROR(jpeg_.decode(*wire, plane.size_px, *packed));
  } else {
    packPlane(*wire, plane, *packed);
  }
  return SharedBytes(std::move(packed));
}

absl::StatusOr<std::unique_ptr<Frame>> FrameDecoder::decode(CollectedFrame collected) {
  auto frame = std::make_unique<Frame>();
  frame->format = std::move(collected.format);
  auto next_wire = collected.planes.begin();
  VIEWLOOM_CHECK(collected.planes.size() == wirePlanes(frame->format).size());
  for (size_t s = 0; s < frame->format.sources.size(); ++s) {
    const std::vector<LayerFormat>& layers = frame->format.sources[s].layers;
    std::vector<LayerPlanes>& decoded = frame->sources.emplace_back(layers.size());
    for (size_t l = 0; l < layers.size(); ++l) {
      const LayerFormat& layer = layers[l];
      for (const size_t p : {0U, 1U}) {
        const bool is_depth = (p == 0) == layer.depth_first;
        absl::StatusOr<SharedBytes> plane =
            decodePlane(is_depth ? layer.depth : layer.color, std::move(*next_wire++));
        if (!plane.ok()) {
          return withFieldPrefix(plane.status(),
                                 strCat("header.sources[", s, "].layers[", l, "].planes[", p, "]"));
        }
        (is_depth ? decoded[l].depth : decoded[l].color) = *std::move(plane);
      }
      decoded[l].color_encoding = layer.color.encoding == PlaneEncoding::kRgba16f
                                      ? PlaneEncoding::kRgba16f
                                      : PlaneEncoding::kRgba8;
    }
  }
  return frame;
}

}  // namespace viewloom
