// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <vector>

#include "base/check.h"
#include "decode/h264_plane.h"
#include "decode/jpeg_plane.h"
#include "decode/plane_decoder.h"
#include "decode/zstd_plane.h"
#include "frame/limits.h"
#include "fuzz/script.h"
#include "fuzz/targets.h"

namespace viewloom {

bool fuzzJpeg(FuzzBytes bytes) {
  static JpegDecoder decoder;
  Script script(bytes);
  const SizePx size_px{script.take(), script.take()};
  std::vector<uint8_t> out;
  const bool decoded = decoder.decode(script.takeRest(), size_px, out).ok();
  VIEWLOOM_CHECK(out.size() <= size_px.area() * 4);
  VIEWLOOM_CHECK(!decoded || out.size() == size_px.area() * 4);
  return decoded;
}

bool fuzzZstd(FuzzBytes bytes) {
  static ZstdInflater inflater;
  Script script(bytes);
  const uint64_t expected = script.take(2) + 1;
  const FuzzBytes wire = script.takeRest();
  const absl::StatusOr<uint64_t> most = ZstdInflater::contentBytesUpTo(wire, expected);
  VIEWLOOM_CHECK(!most.ok() || *most <= expected);
  if (!ZstdInflater::contentBytes(wire, expected).ok()) return false;
  std::vector<uint8_t> out;
  const bool inflated = inflater.inflate(wire, expected, out).ok();
  VIEWLOOM_CHECK(out.size() <= expected);
  VIEWLOOM_CHECK(!inflated || out.size() == expected);
  return inflated;
}

bool fuzzVideoPlane(FuzzBytes bytes) {
  Script script(bytes);
  const SizePx size_px{script.take() + kH264SideMin_px, script.take() + kH264SideMin_px};
  std::vector<uint8_t> out;
  const bool decoded = decodeH264Plane(script.takeRest(), size_px, out).ok();
  VIEWLOOM_CHECK(out.size() <= size_px.area() * 4);
  VIEWLOOM_CHECK(!decoded || out.size() == size_px.area() * 4);
  return decoded;
}

bool fuzzPredicted(FuzzBytes bytes) {
  static BytePool pool(8);
  static PlaneDecoder decoder(pool);
  Script script(bytes);
  const PlaneFormat plane{.kind = PlaneKind::kDepth,
                          .encoding = PlaneEncoding::kDepthU16,
                          .size_px = {script.take() + 1, script.take() + 1},
                          .compression = PlaneCompression::kPredictedZstd};
  const FuzzBytes wire = script.takeRest();
  const absl::StatusOr<SharedBytes> decoded =
      decoder.decode(plane, std::make_shared<const std::vector<uint8_t>>(wire.begin(), wire.end()));
  VIEWLOOM_CHECK(!decoded.ok() || (*decoded)->size() == decodedBytes(plane));
  return decoded.ok();
}

}  // namespace viewloom
