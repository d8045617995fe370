// SPDX-License-Identifier: Apache-2.0
#include "files/jpeg_image.h"

#include <turbojpeg.h>

#include <memory>
#include <utility>

#include "base/str_cat.h"
#include "files/exif.h"
#include "files/file_bytes.h"
#include "files/icc_profile.h"
#include "files/jpeg_segments.h"
#include "files/plane_image.h"

namespace viewloom::files {
namespace {

struct DestroyJpeg {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using JpegHandle = std::unique_ptr<void, DestroyJpeg>;

constexpr uint8_t kBaseline = 0xC0;

struct JpegHeader {
  int width_px = 0;
  int height_px = 0;
  int color_space = 0;
};

absl::StatusOr<JpegHeader> readHeader(const std::string& name, std::span<const uint8_t> bytes,
                                      void* handle) {
  JpegHeader header;
  int subsampling = 0;
  if (tjDecompressHeader3(handle, bytes.data(), bytes.size(), &header.width_px, &header.height_px,
                          &subsampling, &header.color_space) != 0) {
    return refuseFile(name, strCat("is no JPEG that can be read: ", tjGetErrorStr2(handle),
                                   "; copy or export it again"));
  }
  if (header.width_px == 0 && header.height_px == 0) return refuseCutShort(name, "JPEG");
  VIEWLOOM_RETURN_IF_ERROR(checkPlaneSize(name, header.width_px, header.height_px));
  if (header.color_space == TJCS_CMYK || header.color_space == TJCS_YCCK) {
    return refuseFile(name, "is a CMYK JPEG; accepted are grey, YCbCr and RGB");
  }
  return header;
}

}  // namespace

absl::StatusOr<Picture> decodeJpeg(const std::string& name, std::span<const uint8_t> bytes) {
  const JpegSegments segments = readJpegSegments(bytes);
  const JpegHandle handle(tjInitDecompress());
  const absl::StatusOr<JpegHeader> header = readHeader(name, bytes, handle.get());
  if (!header.ok()) return header.status();
  Picture picture{.width_px = static_cast<uint32_t>(header->width_px),
                  .height_px = static_cast<uint32_t>(header->height_px),
                  .channels = 3,
                  .bits = 8,
                  .coding = codingOfIcc(segments.icc),
                  .bytes = {}};
  picture.bytes.resize(size_t{3} * picture.width_px * picture.height_px);
  // TJFLAG_STOPONWARNING: a truncated file is an error, not a half grey picture. TJFLAG_LIMITSCANS:
  // 500 scans at most, against files made to take for ever.
  if (tjDecompress2(handle.get(), bytes.data(), bytes.size(), picture.bytes.data(),
                    header->width_px, 0, header->height_px, TJPF_RGB,
                    TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS) != 0) {
    return segments.end == 0 ? refuseCutShort(name, "JPEG")
                             : refuseDamaged(name, "JPEG", tjGetErrorStr2(handle.get()));
  }
  return turned(std::move(picture), orientationOf(segments.exif));
}

absl::StatusOr<Picture> readJpeg(const std::filesystem::path& path) {
  const absl::StatusOr<std::vector<uint8_t>> bytes = readFileBytes(path);
  if (!bytes.ok()) return bytes.status();
  return decodeJpeg(path.string(), *bytes);
}

absl::StatusOr<PlaneImage> readJpegColor(const std::filesystem::path& path) {
  absl::StatusOr<std::vector<uint8_t>> bytes = readFileBytes(path);
  if (!bytes.ok()) return bytes.status();
  const JpegHandle handle(tjInitDecompress());
  const absl::StatusOr<JpegHeader> header = readHeader(path.string(), *bytes, handle.get());
  if (!header.ok()) return header.status();
  const JpegSegments segments = readJpegSegments(*bytes);
  if (segments.end == 0) return refuseCutShort(path.string(), "JPEG");
  const ColorCoding coding = codingOfIcc(segments.icc);
  const std::optional<Imf::Chromaticities> chromaticities = coding.chromaticities();
  const bool is_known = !chromaticities || knownPrimaries(*chromaticities);
  const bool is_as_sent = segments.frame_marker == kBaseline && segments.scan_count == 1 &&
                          header->color_space != TJCS_RGB && is_known &&
                          orientationOf(segments.exif) == 1;
  if (!is_as_sent || !ToneCurve(v1::COLOR_TRANSFER_UNSPECIFIED, coding, {}).isSrgb()) {
    absl::StatusOr<Picture> picture = decodeJpeg(path.string(), *bytes);
    if (!picture.ok()) return picture.status();
    return colorPlane(*std::move(picture), v1::COLOR_TRANSFER_UNSPECIFIED);
  }
  bytes->resize(segments.end);
  return PlaneImage{.width_px = static_cast<uint32_t>(header->width_px),
                    .height_px = static_cast<uint32_t>(header->height_px),
                    .encoding = v1::PLANE_ENCODING_JPEG,
                    .code_max = 255,
                    .chromaticities = chromaticities,
                    .bytes = *std::move(bytes)};
}

}  // namespace viewloom::files
