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
#include "files/primaries.h"
#include "files/yuv_image.h"

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

// What only some formats know must not be asked of others.
absl::Status refuseForeign(const v1::PlaneFile& file, const std::string& extension) {
  const bool is_exr = extension == ".exr", is_yuv = extension == ".yuv";
  const bool has_parts = extension == ".png" || extension == ".jpg" || extension == ".jpeg";
  if (!is_exr && !file.channels().empty()) {
    return invalidField("channels",
                        absl::StrCat("given for ", file.file(), "; accepted for EXR files only"));
  }
  if (!has_parts && file.part() != v1::IMAGE_PART_UNSPECIFIED) {
    return invalidField(
        "part", absl::StrCat("given for ", file.file(), "; accepted for PNG and JPEG only"));
  }
  if (is_yuv != file.has_raw()) {
    return invalidField("raw", absl::StrCat(is_yuv ? "is missing for " : "given for ", file.file(),
                                            "; it belongs to .yuv files"));
  }
  return absl::OkStatus();
}

absl::StatusOr<PlaneImage> readColor(const v1::PlaneFile& file, const std::filesystem::path& path) {
  const std::string extension = extensionOf(path);
  VIEWLOOM_RETURN_IF_ERROR(refuseForeign(file, extension));
  if (extension == ".exr") {
    const std::vector<std::string> channels(file.channels().begin(), file.channels().end());
    return readExrColor(path, channels);
  }
  if (extension == ".pfm") return readPfmColor(path);
  if (extension == ".yuv") return readYuvColor(path, file.raw());
  const bool is_jpeg = extension == ".jpg" || extension == ".jpeg";
  if (!is_jpeg && extension != ".png") {
    return invalidField("file",
                        absl::StrCat("is ", file.file(),
                                     "; accepted as colour are .exr, .png, .jpg, .pfm and .yuv"));
  }
  if (is_jpeg && file.part() == v1::IMAGE_PART_UNSPECIFIED) return readJpegColor(path);
  absl::StatusOr<Picture> picture = is_jpeg ? readJpeg(path) : readPng(path, PngUse::kColor);
  if (!picture.ok()) return picture.status();
  picture = cutPart(file.file(), *std::move(picture), file.part());
  if (!picture.ok()) return picture.status();
  return colorPlane(*std::move(picture), file.transfer() == v1::COLOR_TRANSFER_LINEAR);
}

absl::StatusOr<PlaneImage> readDepth(const v1::PlaneFile& file, const std::filesystem::path& path) {
  const std::string extension = extensionOf(path);
  VIEWLOOM_RETURN_IF_ERROR(refuseForeign(file, extension));
  if (extension == ".exr") {
    const std::vector<std::string> channels(file.channels().begin(), file.channels().end());
    return readExrDepth(path, channels);
  }
  if (extension == ".pfm") return readPfmDepth(path);
  if (extension == ".yuv") return readYuvDepth(path, file.raw());
  const bool is_jpeg = extension == ".jpg" || extension == ".jpeg";
  if (!is_jpeg && extension != ".png") {
    return invalidField("file",
                        absl::StrCat("is ", file.file(),
                                     "; accepted as depth are .exr, .png, .jpg, .pfm and .yuv"));
  }
  absl::StatusOr<Picture> picture = is_jpeg ? readJpeg(path) : readPng(path, PngUse::kDepth);
  if (!picture.ok()) return picture.status();
  picture = cutPart(file.file(), *std::move(picture), file.part());
  if (!picture.ok()) return picture.status();
  return depthPlane(file.file(), *picture, file.depth().meaning() == v1::DEPTH_MEANING_WINDOW);
}

v1::AlphaMode alphaOf(const PlaneImage& image, const std::filesystem::path& path) {
  if (!image.has_alpha) return v1::ALPHA_MODE_OPAQUE;
  return extensionOf(path) == ".exr" ? v1::ALPHA_MODE_PREMULTIPLIED : v1::ALPHA_MODE_STRAIGHT;
}

}  // namespace

absl::StatusOr<PlaneImage> readColorImage(const v1::PlaneFile& file,
                                          const std::filesystem::path& folder) {
  return readColor(file, resolve(file, folder));
}

LoadedPlane withBytes(PlaneImage image, v1::PlaneKind kind) {
  LoadedPlane loaded;
  loaded.plane.set_kind(kind);
  loaded.plane.set_encoding(image.encoding);
  loaded.plane.mutable_size()->set_width(image.width_px);
  loaded.plane.mutable_size()->set_height(image.height_px);
  loaded.plane.set_bytes_count(image.bytes.size());
  loaded.code_max = image.code_max;
  loaded.bytes = std::make_shared<const std::vector<uint8_t>>(std::move(image.bytes));
  return loaded;
}

absl::StatusOr<LoadedPlane> makeColorPlane(const v1::PlaneFile& file, PlaneImage image) {
  const bool linear = image.encoding == v1::PLANE_ENCODING_RGBA16F;
  if (linear && file.transfer() == v1::COLOR_TRANSFER_SRGB && extensionOf(file.file()) != ".png") {
    return invalidField("transfer", absl::StrCat("is SRGB for ", file.file(),
                                                 "; accepted for EXR and PFM is LINEAR"));
  }
  const v1::AlphaMode alpha =
      file.alpha() == v1::ALPHA_MODE_UNSPECIFIED ? alphaOf(image, file.file()) : file.alpha();
  v1::ColorPrimaries primaries = file.primaries();
  if (primaries == v1::COLOR_PRIMARIES_UNSPECIFIED) {
    const absl::StatusOr<v1::ColorPrimaries> settled = settlePrimaries(file.file(), image);
    if (!settled.ok()) return settled.status();
    primaries = *settled;
  }
  LoadedPlane loaded = withBytes(std::move(image), v1::PLANE_KIND_COLOR);
  loaded.plane.set_transfer(linear ? v1::COLOR_TRANSFER_LINEAR
                            : file.transfer() == v1::COLOR_TRANSFER_UNSPECIFIED
                                ? v1::COLOR_TRANSFER_SRGB
                                : file.transfer());
  loaded.plane.set_primaries(primaries);
  loaded.plane.set_alpha(alpha);
  return loaded;
}

LoadedPlane makeDepthPlane(const v1::PlaneFile& file, PlaneImage image) {
  LoadedPlane loaded = withBytes(std::move(image), v1::PLANE_KIND_DEPTH);
  *loaded.plane.mutable_depth() = file.depth();
  return loaded;
}

absl::StatusOr<LoadedPlane> loadColorPlane(const v1::PlaneFile& file,
                                           const std::filesystem::path& folder) {
  absl::StatusOr<PlaneImage> image = readColor(file, resolve(file, folder));
  if (!image.ok()) return image.status();
  return makeColorPlane(file, *std::move(image));
}

absl::StatusOr<LoadedPlane> loadDepthPlane(const v1::PlaneFile& file,
                                           const std::filesystem::path& folder) {
  absl::StatusOr<PlaneImage> image = readDepth(file, resolve(file, folder));
  if (!image.ok()) return image.status();
  return makeDepthPlane(file, *std::move(image));
}

}  // namespace viewloom::files
