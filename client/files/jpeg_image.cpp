// SPDX-License-Identifier: Apache-2.0
#include "files/jpeg_image.h"

#include <turbojpeg.h>

#include <memory>

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

}  // namespace

absl::StatusOr<PlaneImage> readJpegColor(const std::filesystem::path& path) {
  absl::StatusOr<std::vector<uint8_t>> bytes = readFileBytes(path);
  if (!bytes.ok()) return bytes.status();
  const JpegHandle handle(tjInitDecompress());
  int width = 0, height = 0, subsampling = 0, color_space = 0;
  if (tjDecompressHeader3(handle.get(), bytes->data(), bytes->size(), &width, &height, &subsampling,
                          &color_space) != 0) {
    return refuseFile(path.string(), absl::StrCat("is no JPEG: ", tjGetErrorStr2(handle.get())));
  }
  if (absl::Status size = checkPlaneSize(path.string(), width, height); !size.ok()) return size;
  if (color_space == TJCS_CMYK || color_space == TJCS_YCCK) {
    return refuseFile(path.string(), "is a CMYK JPEG; accepted are grey, YCbCr and RGB");
  }
  PlaneImage image{.width_px = static_cast<uint32_t>(width),
                   .height_px = static_cast<uint32_t>(height),
                   .encoding = v1::PLANE_ENCODING_JPEG,
                   .has_alpha = false,
                   .bytes = {}};
  if (isBaseline(*bytes) && color_space != TJCS_RGB) {
    image.bytes = *std::move(bytes);
    return image;
  }
  image.encoding = v1::PLANE_ENCODING_RGB8;
  image.bytes.resize(size_t{3} * image.width_px * image.height_px);
  // TJFLAG_STOPONWARNING: a truncated file is an error, not a half grey picture. TJFLAG_LIMITSCANS:
  // 500 scans at most, against files made to take for ever.
  if (tjDecompress2(handle.get(), bytes->data(), bytes->size(), image.bytes.data(), width, 0,
                    height, TJPF_RGB, TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS) != 0) {
    return absl::DataLossError(absl::StrCat(path.string(), ": ", tjGetErrorStr2(handle.get())));
  }
  return image;
}

}  // namespace viewloom::files
