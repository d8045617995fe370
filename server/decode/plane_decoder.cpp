// SPDX-License-Identifier: Apache-2.0
#include "decode/plane_decoder.h"

#include <algorithm>
#include <utility>

#include "base/check.h"
#include "decode/h264_plane.h"
#include "decode/predicted_plane.h"
#include "decode/rgb_to_rgba.h"
#include "frame/limits.h"
#include "frame/plane_encoding.h"

namespace viewloom {
namespace {

// `bytes` are the plane's uncompressed bytes, with its stride; `out` becomes the packed plane:
// strides go, RGB8 becomes RGBA8.
void packPlane(std::span<const uint8_t> bytes, const PlaneFormat& plane,
               std::vector<uint8_t>& out) {
  VIEWLOOM_CHECK(bytes.size() == uncompressedBytes(plane));
  const size_t stride_bytes = wireRowBytes(plane);
  const size_t row_bytes = size_t{plane.size_px.width} * wirePixelBytes(plane.encoding);
  const size_t out_row_bytes = decodedBytes(plane) / plane.size_px.height;
  out.resize(decodedBytes(plane));
  for (size_t y = 0; y < plane.size_px.height; ++y) {
    const std::span<const uint8_t> row = bytes.subspan(y * stride_bytes, row_bytes);
    uint8_t* out_row = out.data() + y * out_row_bytes;
    if (plane.encoding == PlaneEncoding::kRgb8) {
      widenRgb(row, out_row);
    } else {
      std::copy(row.begin(), row.end(), out_row);
    }
  }
}

}  // namespace

absl::StatusOr<SharedBytes> PlaneDecoder::inflate(const PlaneFormat& plane,
                                                  const SharedBytes& wire) {
  const absl::StatusOr<uint64_t> content_bytes =
      plane.encoding == PlaneEncoding::kJpeg
          ? ZstdInflater::contentBytesUpTo(*wire, inflatedBytesMax(plane))
          : ZstdInflater::contentBytes(*wire, uncompressedBytes(plane));
  if (!content_bytes.ok()) return content_bytes.status();
  BytePool::Buffer inflated = pool_.takeUncleared(*content_bytes);
  VIEWLOOM_RETURN_IF_ERROR(zstd_.inflate(*wire, *content_bytes, *inflated));
  return SharedBytes(std::move(inflated));
}

absl::StatusOr<SharedBytes> PlaneDecoder::decode(const PlaneFormat& plane, SharedBytes wire) {
  if (plane.compression != PlaneCompression::kNone) {
    absl::StatusOr<SharedBytes> inflated = inflate(plane, wire);
    if (!inflated.ok()) return inflated.status();
    wire = *std::move(inflated);
  }
  if (plane.compression == PlaneCompression::kPredictedZstd) {
    BytePool::Buffer restored = pool_.takeUncleared(decodedBytes(plane));
    restorePredicted(*wire, plane.size_px, *restored);
    return SharedBytes(std::move(restored));
  }
  if (isHeldAsSent(plane)) return wire;
  BytePool::Buffer packed = pool_.takeUncleared(decodedBytes(plane));
  if (plane.encoding == PlaneEncoding::kJpeg) {
    VIEWLOOM_RETURN_IF_ERROR(jpeg_.decode(*wire, plane.size_px, *packed));
  } else if (plane.encoding == PlaneEncoding::kH264) {
    VIEWLOOM_RETURN_IF_ERROR(decodeH264Plane(*wire, plane.size_px, *packed));
  } else {
    packPlane(*wire, plane, *packed);
  }
  return SharedBytes(std::move(packed));
}

}  // namespace viewloom
