// SPDX-License-Identifier: Apache-2.0
#include "decode/plane_decoder.h"

#include <utility>

#include "decode/predicted_plane.h"
#include "decode/raw_plane.h"
#include "frame/limits.h"

namespace viewloom {

absl::StatusOr<SharedBytes> PlaneDecoder::inflate(const PlaneFormat& plane,
                                                  const SharedBytes& wire) {
  const absl::StatusOr<uint64_t> content_bytes =
      plane.encoding == PlaneEncoding::kJpeg
          ? ZstdInflater::contentBytesUpTo(*wire, jpegBytesMax(plane.size_px.area()))
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
  if (isPacked(plane)) return wire;
  BytePool::Buffer packed = pool_.takeUncleared(decodedBytes(plane));
  if (plane.encoding == PlaneEncoding::kJpeg) {
    VIEWLOOM_RETURN_IF_ERROR(jpeg_.decode(*wire, plane.size_px, *packed));
  } else {
    packPlane(*wire, plane, *packed);
  }
  return SharedBytes(std::move(packed));
}

}  // namespace viewloom
