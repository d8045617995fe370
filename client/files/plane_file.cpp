// SPDX-License-Identifier: Apache-2.0
#include "files/plane_file.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/str_cat.h"
#include "files/container.h"
#include "files/depth_packing.h"
#include "files/exr_image.h"
#include "files/foreign_file.h"
#include "files/jpeg_image.h"
#include "files/picture_file.h"
#include "files/plane_image.h"
#include "files/yuv_image.h"

namespace viewloom::files {
namespace {

// A relative name starts at the folder; std::filesystem leaves absolute ones alone.
std::filesystem::path resolve(const v1::PlaneFile& file, const std::filesystem::path& folder) {
  return folder / file.file();
}

// Refuses settings of formats that the file does not have.
absl::Status refuseForeign(const v1::PlaneFile& file, Container container) {
  const bool is_exr = container == Container::kExr, is_yuv = container == Container::kYuv;
  if (!is_exr && !file.channels().empty()) {
    return invalidField("channels",
                        strCat("given for ", file.file(), "; accepted for EXR files only"));
  }
  if (!is_exr && file.has_window()) {
    return invalidField("window",
                        strCat("given for ", file.file(), "; accepted for EXR files only"));
  }
  if ((is_exr || is_yuv) && file.part() != v1::IMAGE_PART_UNSPECIFIED) {
    return invalidField("part", strCat("given for ", file.file(),
                                       "; accepted for PNG, JPEG and other pictures, not "
                                       "for EXR and .yuv"));
  }
  if (is_exr && file.transfer() == v1::COLOR_TRANSFER_SRGB) {
    return invalidField("transfer",
                        strCat("is SRGB for ", file.file(), "; accepted for EXR is LINEAR"));
  }
  if ((is_exr || is_yuv) && file.packing() != v1::DEPTH_PACKING_UNSPECIFIED) {
    return invalidField("packing", strCat("given for ", file.file(),
                                          "; accepted for pictures of 8 bits a channel"));
  }
  if (is_yuv != file.has_raw()) {
    return invalidField("raw", strCat(is_yuv ? "is missing for " : "given for ", file.file(),
                                      "; it belongs to .yuv files"));
  }
  if (container != Container::kHeic) return absl::OkStatus();
  return invalidField(
      "file", strCat("is ", file.file(), ", a HEIC photo; accepted here are ", kPictureKinds,
                     " without HEIC: give photos as the colour of publish or inspect"));
}

absl::StatusOr<Picture> readPart(const v1::PlaneFile& file, const std::filesystem::path& path,
                                 PictureUse use) {
  absl::StatusOr<Picture> picture = readPicture(path, use);
  if (!picture.ok()) return picture.status();
  return cutPart(file.file(), *std::move(picture), file.part());
}

absl::StatusOr<PlaneImage> readColor(const v1::PlaneFile& file, const std::filesystem::path& path) {
  VIEWLOOM_RETURN_IF_ERROR(checkPictureFile(path));
  const Container container = containerOf(path);
  VIEWLOOM_RETURN_IF_ERROR(refuseForeign(file, container));
  if (container == Container::kExr) {
    const std::vector<std::string> channels(file.channels().begin(), file.channels().end());
    return readExrColor(path, channels, exrWindow(file.window()));
  }
  if (container == Container::kYuv) return readYuvColor(path, file.raw());
  const bool is_whole = file.part() == v1::IMAGE_PART_UNSPECIFIED && !file.flip();
  if (container == Container::kJpeg && is_whole) return readJpegColor(path);
  absl::StatusOr<Picture> picture = readPart(file, path, PictureUse::kColor);
  if (!picture.ok()) return picture.status();
  return colorPlane(*std::move(picture), file.transfer());
}

// The sample where an EXR file has no data: the number that stands for nothing elsewhere in the
// file, as a renderer crops to what it hit. Without such a number it is no surface.
float nothingOf(const v1::DepthFormat& format) {
  if (format.has_invalid_value()) return static_cast<float>(format.invalid_value());
  const bool is_metric = format.meaning() == v1::DEPTH_MEANING_PLANAR ||
                         format.meaning() == v1::DEPTH_MEANING_RAY_DISTANCE;
  const bool is_zero = is_metric && format.offset() == 0;
  return is_zero ? 0 : std::numeric_limits<float>::quiet_NaN();
}

absl::StatusOr<PlaneImage> readDepth(const v1::PlaneFile& file, const std::filesystem::path& path) {
  VIEWLOOM_RETURN_IF_ERROR(checkPictureFile(path));
  const Container container = containerOf(path);
  VIEWLOOM_RETURN_IF_ERROR(refuseForeign(file, container));
  if (container == Container::kExr) {
    const std::vector<std::string> channels(file.channels().begin(), file.channels().end());
    return readExrDepth(path, channels, exrWindow(file.window()), nothingOf(file.depth()));
  }
  if (container == Container::kYuv) return readYuvDepth(path, file.raw());
  const bool has_digits =
      file.packing() != v1::DEPTH_PACKING_UNSPECIFIED && file.packing() != v1::DEPTH_PACKING_HUE;
  if (has_digits && container == Container::kJpeg) {
    return invalidField("packing", strCat("given for ", file.file(),
                                          ", a JPEG, which changes digits; accepted are "
                                          "lossless pictures, as PNG"));
  }
  absl::StatusOr<Picture> picture = readPart(file, path, PictureUse::kDepth);
  if (picture.ok() && file.packing() != v1::DEPTH_PACKING_UNSPECIFIED) {
    picture = unpackDepth(file.file(), *picture, file.packing());
  }
  if (!picture.ok()) return picture.status();
  if (file.code_max() != 0 && picture->bits != 32) picture->code_max = file.code_max();
  return depthPlane(file.file(), *picture, file.depth().meaning() == v1::DEPTH_MEANING_WINDOW);
}

v1::AlphaMode alphaOf(const PlaneImage& image) {
  if (!image.has_alpha) return v1::ALPHA_MODE_OPAQUE;
  return image.is_premultiplied ? v1::ALPHA_MODE_PREMULTIPLIED : v1::ALPHA_MODE_STRAIGHT;
}

}  // namespace

std::optional<ExrWindow> exrWindow(const v1::ExrWindow& window) {
  if (!window.has_size()) return std::nullopt;
  // Sizes are limited to what planes have, corners to what keeps the sums below 2^31.
  const auto corner = [](int32_t at) { return std::clamp(at, -(1 << 30), 1 << 30); };
  const auto side = [](uint32_t px) { return static_cast<int32_t>(std::min(px, 1U << 20)); };
  const int32_t x = corner(window.min_x()), y = corner(window.min_y());
  return ExrWindow{x, y, x + side(window.size().width()) - 1, y + side(window.size().height()) - 1};
}

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
  const v1::ColorTransfer stored =
      image.transfer == v1::COLOR_TRANSFER_UNSPECIFIED ? v1::COLOR_TRANSFER_SRGB : image.transfer;
  const v1::AlphaMode alpha =
      file.alpha() == v1::ALPHA_MODE_UNSPECIFIED ? alphaOf(image) : file.alpha();
  if (file.flip()) flipRows(image.bytes, image.height_px);
  v1::ColorPrimaries primaries = file.primaries();
  if (primaries == v1::COLOR_PRIMARIES_UNSPECIFIED) {
    const absl::StatusOr<v1::ColorPrimaries> settled = settlePrimaries(file.file(), image);
    if (!settled.ok()) return settled.status();
    primaries = *settled;
  }
  LoadedPlane loaded = withBytes(std::move(image), v1::PLANE_KIND_COLOR);
  loaded.plane.set_transfer(linear ? v1::COLOR_TRANSFER_LINEAR
                            : file.transfer() == v1::COLOR_TRANSFER_UNSPECIFIED ? stored
                                                                                : file.transfer());
  loaded.plane.set_primaries(primaries);
  loaded.plane.set_alpha(alpha);
  return loaded;
}

LoadedPlane makeDepthPlane(const v1::PlaneFile& file, PlaneImage image) {
  if (file.flip()) flipRows(image.bytes, image.height_px);
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
