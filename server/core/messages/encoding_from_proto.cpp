// SPDX-License-Identifier: Apache-2.0
#include "messages/encoding_from_proto.h"

#include "display/atlas_layout.h"
#include "display/rgbd.h"
#include "messages/enum_from_proto.h"

namespace viewloom {
namespace {

constexpr EnumRow<v1::BandEncoding, BandEncoding> kColorEncodings[] = {
    {v1::BAND_ENCODING_UNSPECIFIED, BandEncoding::kJpeg},
    {v1::BAND_ENCODING_JPEG, BandEncoding::kJpeg},
    {v1::BAND_ENCODING_JPEG_PLANES, BandEncoding::kJpegPlanes},
    {v1::BAND_ENCODING_ZSTD, BandEncoding::kZstd},
    {v1::BAND_ENCODING_RAW, BandEncoding::kRaw}};

constexpr EnumRow<v1::BandEncoding, BandEncoding> kPlaneEncodings[] = {
    {v1::BAND_ENCODING_UNSPECIFIED, BandEncoding::kZstd},
    {v1::BAND_ENCODING_JPEG, BandEncoding::kJpeg},
    {v1::BAND_ENCODING_JPEG_PLANES, BandEncoding::kJpegPlanes},
    {v1::BAND_ENCODING_ZSTD, BandEncoding::kZstd},
    {v1::BAND_ENCODING_RAW, BandEncoding::kRaw}};

constexpr EnumRow<v1::ChromaSubsampling, Chroma> kChromas[] = {
    {v1::CHROMA_SUBSAMPLING_UNSPECIFIED, Chroma::k420},
    {v1::CHROMA_SUBSAMPLING_420, Chroma::k420},
    {v1::CHROMA_SUBSAMPLING_444, Chroma::k444}};

}  // namespace

absl::StatusOr<EncodingSpec> encodingFromProto(const v1::AtlasEncoding& proto,
                                               const DisplaySpec& display) {
  EncodingSpec encoding;
  const auto color = enumFromProto(proto.color(), "color", kColorEncodings);
  VIEWLOOM_RETURN_IF_ERROR(color.status());
  const auto chroma = enumFromProto(proto.chroma(), "chroma", kChromas);
  VIEWLOOM_RETURN_IF_ERROR(chroma.status());
  const auto planes = enumFromProto(proto.planes(), "planes", kPlaneEncodings);
  VIEWLOOM_RETURN_IF_ERROR(planes.status());
  encoding.color = *color;
  encoding.chroma = *chroma;
  const bool has_channels = tileGridOf(display).rays_per_px > 1;  // shared chroma would mix them
  if (has_channels) {
    if (proto.color() == v1::BAND_ENCODING_UNSPECIFIED) encoding.color = BandEncoding::kJpegPlanes;
    if (proto.chroma() == v1::CHROMA_SUBSAMPLING_UNSPECIFIED) encoding.chroma = Chroma::k444;
  }
  // Colour that greys share chroma with shows at their edge.
  if (showsDepth(display) && proto.chroma() == v1::CHROMA_SUBSAMPLING_UNSPECIFIED) {
    encoding.chroma = Chroma::k444;
  }
  encoding.with_depth_codes = hasDepthPlane(display);
  encoding.planes = *planes;
  if (proto.jpeg_quality() != 0) encoding.jpeg_quality = proto.jpeg_quality();
  encoding.with_depth = proto.with_depth();
  encoding.with_mask = proto.with_mask();
  VIEWLOOM_RETURN_IF_ERROR(validateEncodingSpec(encoding));
  VIEWLOOM_RETURN_IF_ERROR(validateEncodingOf(display, encoding));
  return encoding;
}

}  // namespace viewloom
