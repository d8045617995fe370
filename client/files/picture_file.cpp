// SPDX-License-Identifier: Apache-2.0
#include "files/picture_file.h"

#include "files/file_bytes.h"
#include "files/jpeg_image.h"
#include "files/netpbm_image.h"
#include "files/png_image.h"

namespace viewloom::files {

absl::StatusOr<Picture> readPicture(const std::filesystem::path& path, PictureUse use) {
  VIEWLOOM_RETURN_IF_ERROR(checkPictureFile(path));
  const Container container = containerOf(path);
  if (container == Container::kPng) return readPng(path, use);
  const absl::StatusOr<std::vector<uint8_t>> bytes = readFileBytes(path);
  if (!bytes.ok()) return bytes.status();
  const std::string name = path.string();
  switch (container) {
    case Container::kJpeg:
      return decodeJpeg(name, *bytes);
    case Container::kPfm:
      return decodePfm(name, *bytes);
    case Container::kPnm:
      return decodePnm(name, *bytes);
    case Container::kNpy:
      return decodeNpy(name, *bytes);
    case Container::kTiff:
      return decodeTiff(name, *bytes, use);
    case Container::kWebp:
      return decodeWebp(name, *bytes);
    case Container::kBmp:
      return decodeBmp(name, *bytes);
    case Container::kDpt:
      return decodeDpt(name, *bytes);
    default:
      return refuseFile(name,
                        "is no picture that can be read here; accepted are PNG, JPEG, TIFF, "
                        "WebP, PFM, PGM, PPM, BMP, NPY and DPT");
  }
}

}  // namespace viewloom::files
