// SPDX-License-Identifier: Apache-2.0
#include "files/surface_file.h"

#include <Imath/half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "base/str_cat.h"

namespace viewloom::files {
namespace {

absl::Status checkFields(const v1::PlaneFile& file) {
  const char* const foreign = file.transfer() != v1::COLOR_TRANSFER_UNSPECIFIED     ? "transfer"
                              : file.primaries() != v1::COLOR_PRIMARIES_UNSPECIFIED ? "primaries"
                              : file.alpha() != v1::ALPHA_MODE_UNSPECIFIED          ? "alpha"
                              : file.has_depth()                                    ? "depth"
                                                                                    : nullptr;
  if (foreign == nullptr) return absl::OkStatus();
  return invalidField(foreign,
                      strCat("given for ", file.file(), ", whose samples count as they are"));
}

// Samples of a px, as they are stored.
size_t channelsOf(v1::PlaneEncoding encoding) {
  return encoding == v1::PLANE_ENCODING_RGB8 ? 3 : 4;
}

float halfAt(const PlaneImage& image, size_t sample) {
  Imath::half value;
  std::memcpy(&value, &image.bytes[2 * sample], sizeof value);
  return value;
}

// The first channels of every px, 8 bits each.
std::vector<uint8_t> bytesOf(const PlaneImage& image, size_t channel_count) {
  const size_t stored = channelsOf(image.encoding);
  const size_t px_count = size_t{image.width_px} * image.height_px;
  std::vector<uint8_t> bytes(channel_count * px_count);
  for (size_t i = 0; i < bytes.size(); ++i) {
    const size_t sample = i / channel_count * stored + i % channel_count;
    bytes[i] = image.encoding == v1::PLANE_ENCODING_RGBA16F
                   ? uint8_t(std::lround(255 * std::clamp(halfAt(image, sample), 0.0F, 1.0F)))
                   : image.bytes[sample];
  }
  return bytes;
}

// `is_unsigned`: 0..1 stands for -1..1.
std::vector<uint8_t> halfVectors(const PlaneImage& image, bool is_unsigned) {
  const size_t px_count = size_t{image.width_px} * image.height_px;
  std::vector<uint8_t> bytes(6 * px_count);
  for (size_t i = 0; i < 3 * px_count; ++i) {
    const float stored = halfAt(image, i / 3 * 4 + i % 3);
    const uint16_t bits = Imath::half(is_unsigned ? 2 * stored - 1 : stored).bits();
    std::memcpy(&bytes[2 * i], &bits, sizeof bits);
  }
  return bytes;
}

}  // namespace

absl::StatusOr<LoadedPlane> loadSurfacePlane(const v1::PlaneFile& file,
                                             const std::filesystem::path& folder,
                                             v1::PlaneKind kind) {
  VIEWLOOM_RETURN_IF_ERROR(checkFields(file));
  v1::PlaneFile as_stored = file;
  as_stored.set_transfer(v1::COLOR_TRANSFER_LINEAR);
  absl::StatusOr<PlaneImage> image = readColorImage(as_stored, folder);
  if (!image.ok()) return image.status();
  const bool is_half = image->encoding == v1::PLANE_ENCODING_RGBA16F;
  PlaneImage plane{.width_px = image->width_px, .height_px = image->height_px, .bytes = {}};
  const bool is_normal = kind == v1::PLANE_KIND_NORMAL;
  const bool is_whole = image->code_max != 0;  // v of at most n stands for v / n
  if (kind == v1::PLANE_KIND_MOTION && is_whole) {
    return invalidField("file", strCat("is ", file.file(),
                                       ", of whole numbers; accepted are floats, as EXR, "
                                       "PFM and TIFF have them"));
  }
  if (image->encoding == v1::PLANE_ENCODING_JPEG) {
    return invalidField("file", strCat("is ", file.file(),
                                       ", a JPEG, which changes numbers; accepted are EXR, "
                                       "PNG, PFM and other lossless files"));
  }
  if (kind == v1::PLANE_KIND_MOTION || (is_normal && is_half)) {
    plane.encoding = v1::PLANE_ENCODING_XYZ16F;
    plane.bytes = halfVectors(*image, is_whole);
  } else if (kind == v1::PLANE_KIND_ROUGHNESS) {
    plane.encoding = v1::PLANE_ENCODING_R8;
    plane.bytes = bytesOf(*image, 1);
  } else {
    plane.encoding = is_normal ? v1::PLANE_ENCODING_XYZ8 : v1::PLANE_ENCODING_RGB8;
    plane.bytes = bytesOf(*image, 3);
  }
  return withBytes(std::move(plane), kind);
}

}  // namespace viewloom::files
