// SPDX-License-Identifier: Apache-2.0
#include "files/plane_file.h"

#include <algorithm>
#include <cctype>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "files/exr_image.h"
#include "files/jpeg_image.h"
#include "files/pfm_image.h"
#include "files/plane_image.h"
#include "files/png_image.h"

namespace viewloom::files {
namespace {

std::string extensionOf(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

// A relative name starts at the folder; std::filesystem leaves absolute ones alone.
std::filesystem::path resolve(const v1::PlaneFile& file, const std::filesystem::path& folder) {
  return folder / file.file();
}

absl::Status refuseChannels(const v1::PlaneFile& file) {
  if (file.channels().empty()) return absl::OkStatus();
  return invalidField("channels",
                      absl::StrCat("given for ", file.file(), "; accepted for EXR files only"));
}

absl::StatusOr<PlaneImage> readColor(const v1::PlaneFile& file, const std::filesystem::path& path) {
  const std::string extension = extensionOf(path);
  if (extension == ".exr") {
    const std::vector<std::string> channels(file.channels().begin(), file.channels().end());
    return readExrColor(path, channels);
  }
  VIEWLOOM_RETURN_IF_ERROR(refuseChannels(file));
  if (extension == ".png") {
    return readPngColor(path, file.transfer() == v1::COLOR_TRANSFER_LINEAR);
  }
  if (extension == ".jpg" || extension == ".jpeg") return readJpegColor(path);
  if (extension == ".pfm") return readPfmColor(path);
  return invalidField("file", absl::StrCat("is ", file.file(),
                                           "; accepted as colour are .exr, .png, .jpg and .pfm"));
}

absl::StatusOr<PlaneImage> readDepth(const v1::PlaneFile& file, const std::filesystem::path& path) {
  const std::string extension = extensionOf(path);
  if (extension == ".exr") {
    const std::vector<std::string> channels(file.channels().begin(), file.channels().end());
    return readExrDepth(path, channels);
  }
  VIEWLOOM_RETURN_IF_ERROR(refuseChannels(file));
  if (extension == ".png") {
    return readPngDepth(path, file.depth().meaning() == v1::DEPTH_MEANING_WINDOW);
  }
  if (extension == ".pfm") return readPfmDepth(path);
  return invalidField(
      "file", absl::StrCat("is ", file.file(), "; accepted as depth are .exr, .png and .pfm"));
}

LoadedPlane withBytes(PlaneImage image, v1::PlaneKind kind) {
  LoadedPlane loaded;
  loaded.plane.set_kind(kind);
  loaded.plane.set_encoding(image.encoding);
  loaded.plane.mutable_size()->set_width(image.width_px);
  loaded.plane.mutable_size()->set_height(image.height_px);
  loaded.plane.set_bytes_count(image.bytes.size());
  loaded.bytes = std::make_shared<const std::vector<uint8_t>>(std::move(image.bytes));
  return loaded;
}

v1::AlphaMode alphaOf(const PlaneImage& image, const std::filesystem::path& path) {
  if (!image.has_alpha) return v1::ALPHA_MODE_OPAQUE;
  return extensionOf(path) == ".exr" ? v1::ALPHA_MODE_PREMULTIPLIED : v1::ALPHA_MODE_STRAIGHT;
}

}  // namespace

absl::StatusOr<LoadedPlane> loadColorPlane(const v1::PlaneFile& file,
                                           const std::filesystem::path& folder) {
  const std::filesystem::path path = resolve(file, folder);
  absl::StatusOr<PlaneImage> image = readColor(file, path);
  if (!image.ok()) return image.status();
  const bool linear = image->encoding == v1::PLANE_ENCODING_RGBA16F;
  if (linear && file.transfer() == v1::COLOR_TRANSFER_SRGB && extensionOf(path) != ".png") {
    return invalidField("transfer", absl::StrCat("is SRGB for ", file.file(),
                                                 "; accepted for EXR and PFM is LINEAR"));
  }
  const v1::AlphaMode alpha =
      file.alpha() == v1::ALPHA_MODE_UNSPECIFIED ? alphaOf(*image, path) : file.alpha();
  LoadedPlane loaded = withBytes(*std::move(image), v1::PLANE_KIND_COLOR);
  loaded.plane.set_transfer(linear ? v1::COLOR_TRANSFER_LINEAR
                            : file.transfer() == v1::COLOR_TRANSFER_UNSPECIFIED
                                ? v1::COLOR_TRANSFER_SRGB
                                : file.transfer());
  loaded.plane.set_primaries(file.primaries());
  loaded.plane.set_alpha(alpha);
  return loaded;
}

absl::StatusOr<LoadedPlane> loadDepthPlane(const v1::PlaneFile& file,
                                           const std::filesystem::path& folder) {
  absl::StatusOr<PlaneImage> image = readDepth(file, resolve(file, folder));
  if (!image.ok()) return image.status();
  LoadedPlane loaded = withBytes(*std::move(image), v1::PLANE_KIND_DEPTH);
  *loaded.plane.mutable_depth() = file.depth();
  return loaded;
}

}  // namespace viewloom::files
