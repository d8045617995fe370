// SPDX-License-Identifier: Apache-2.0
#include "files/jpeg_image.h"

#include <turbojpeg.h>

#include <memory>
#include <utility>

#include "absl/strings/str_cat.h"
#include "files/file_bytes.h"

namespace viewloom::files {
namespace {

struct DestroyJpeg {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using JpegHandle = std::unique_ptr<void, DestroyJpeg>;

// The first frame marker says how the picture is coded: SOF0 is baseline.
bool isBaseline(const std::vector<uint8_t>& bytes) {
  size_t at = 2;  // after SOI
  while (at + 4 <= bytes.size() && bytes[at] == 0xFF) {
    const uint8_t marker = bytes[at + 1];
    const bool is_table = marker == 0xC4 || marker == 0xC8 || marker == 0xCC;
    if (marker >= 0xC0 && marker <= 0xCF && !is_table) return marker == 0xC0;
    at += 2 + (size_t{bytes[at + 2]} << 8 | bytes[at + 3]);
  }
  return false;
}

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
    return refuseFile(name, absl::StrCat("is no JPEG: ", tjGetErrorStr2(handle)));
  }
  VIEWLOOM_RETURN_IF_ERROR(checkPlaneSize(name, header.width_px, header.height_px));
  if (header.color_space == TJCS_CMYK || header.color_space == TJCS_YCCK) {
    return refuseFile(name, "is a CMYK JPEG; accepted are grey, YCbCr and RGB");
  }
  return header;
}

}  // namespace

absl::StatusOr<Picture> decodeJpeg(const std::string& name, std::span<const uint8_t> bytes) {
  const JpegHandle handle(tjInitDecompress());
  const absl::StatusOr<JpegHeader> header = readHeader(name, bytes, handle.get());
  if (!header.ok()) return header.status();
  Picture picture{.width_px = static_cast<uint32_t>(header->width_px),
                  .height_px = static_cast<uint32_t>(header->height_px),
                  .channels = 3,
                  .bits = 8,
                  .bytes = {}};
  picture.bytes.resize(size_t{3} * picture.width_px * picture.height_px);
  // TJFLAG_STOPONWARNING: a truncated file is an error, not a half grey picture. TJFLAG_LIMITSCANS:
  // 500 scans at most, against files made to take for ever.
  if (tjDecompress2(handle.get(), bytes.data(), bytes.size(), picture.bytes.data(),
                    header->width_px, 0, header->height_px, TJPF_RGB,
                    TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS) != 0) {
    return absl::DataLossError(absl::StrCat(name, ": ", tjGetErrorStr2(handle.get())));
  }
  return picture;
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
  if (!isBaseline(*bytes) || header->color_space == TJCS_RGB) {
    absl::StatusOr<Picture> picture = decodeJpeg(path.string(), *bytes);
    if (!picture.ok()) return picture.status();
    return colorPlane(*std::move(picture), false);
  }
  return PlaneImage{.width_px = static_cast<uint32_t>(header->width_px),
                    .height_px = static_cast<uint32_t>(header->height_px),
                    .encoding = v1::PLANE_ENCODING_JPEG,
                    .has_alpha = false,
                    .bytes = *std::move(bytes)};
}

}  // namespace viewloom::files
