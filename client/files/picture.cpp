// SPDX-License-Identifier: Apache-2.0
#include "files/picture.h"

#include <Imath/half.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "absl/strings/str_cat.h"
#include "files/file_bytes.h"

namespace viewloom::files {
namespace {

// Mean difference between channels, as a share of the largest code. JPEG gives grey a thousandth,
// colour maps of depth are beyond a tenth.
constexpr double kGreyDifferenceMax = 0.02;

uint32_t sampleAt(const Picture& picture, size_t index) {
  if (picture.bits == 8) return picture.bytes[index];
  uint16_t value = 0;
  std::memcpy(&value, &picture.bytes[2 * index], sizeof(value));
  return value;
}

float linearFromSrgb(float srgb) {
  return srgb <= 0.04045F ? srgb / 12.92F : std::pow((srgb + 0.055F) / 1.055F, 2.4F);
}

std::vector<uint8_t> halfRgba(const Picture& picture, bool linear_samples) {
  const size_t pixel_count = size_t{picture.width_px} * picture.height_px;
  std::vector<uint8_t> bytes(8 * pixel_count);
  for (size_t pixel = 0; pixel < pixel_count; ++pixel) {
    std::array<uint16_t, 4> rgba{0, 0, 0, Imath::half(1.0F).bits()};
    for (size_t channel = 0; channel < picture.channels; ++channel) {
      const uint32_t sample = sampleAt(picture, pixel * picture.channels + channel);
      const float stored = static_cast<float>(sample) / 65535.0F;
      const bool as_is = linear_samples || channel == 3;
      rgba[channel] = Imath::half(as_is ? stored : linearFromSrgb(stored)).bits();
    }
    std::memcpy(&bytes[8 * pixel], rgba.data(), 8);
  }
  return bytes;
}

// Of the colours of a picture with three channels or more.
double meanChannelDifference(const Picture& picture) {
  const size_t pixel_count = size_t{picture.width_px} * picture.height_px;
  uint64_t sum = 0;
  for (size_t pixel = 0; pixel < pixel_count; ++pixel) {
    const size_t at = pixel * picture.channels;
    const auto [least, most] =
        std::minmax({sampleAt(picture, at), sampleAt(picture, at + 1), sampleAt(picture, at + 2)});
    sum += most - least;
  }
  const double code_max = picture.bits == 8 ? 255 : 65535;
  return static_cast<double>(sum) / (static_cast<double>(pixel_count) * code_max);
}

}  // namespace

absl::StatusOr<Picture> cutPart(const std::string& file, Picture picture, v1::ImagePart part) {
  if (part == v1::IMAGE_PART_UNSPECIFIED) return picture;
  const bool beside = part == v1::IMAGE_PART_LEFT || part == v1::IMAGE_PART_RIGHT;
  if ((beside ? picture.width_px : picture.height_px) % 2 != 0) {
    return refuseFile(file, absl::StrCat("is ", picture.width_px, "x", picture.height_px,
                                         " px; halves need an even ", beside ? "width" : "height"));
  }
  Picture cut{.width_px = beside ? picture.width_px / 2 : picture.width_px,
              .height_px = beside ? picture.height_px : picture.height_px / 2,
              .channels = picture.channels,
              .bits = picture.bits,
              .bytes = {}};
  const size_t pixel_bytes = size_t{picture.channels} * (picture.bits / 8);
  const size_t row_bytes = pixel_bytes * picture.width_px;
  const size_t first_x = part == v1::IMAGE_PART_RIGHT ? cut.width_px : 0;
  const size_t first_y = part == v1::IMAGE_PART_BOTTOM ? cut.height_px : 0;
  cut.bytes.resize(pixel_bytes * cut.width_px * cut.height_px);
  for (size_t y = 0; y < cut.height_px; ++y) {
    std::memcpy(&cut.bytes[y * pixel_bytes * cut.width_px],
                &picture.bytes[(first_y + y) * row_bytes + first_x * pixel_bytes],
                pixel_bytes * cut.width_px);
  }
  return cut;
}

PlaneImage colorPlane(Picture picture, bool linear_samples) {
  const bool has_alpha = picture.channels == 4;
  PlaneImage image{.width_px = picture.width_px,
                   .height_px = picture.height_px,
                   .encoding = has_alpha ? v1::PLANE_ENCODING_RGBA8 : v1::PLANE_ENCODING_RGB8,
                   .has_alpha = has_alpha,
                   .bytes = {}};
  if (picture.bits == 16) {
    image.encoding = v1::PLANE_ENCODING_RGBA16F;
    image.bytes = halfRgba(picture, linear_samples);
  } else {
    image.bytes = std::move(picture.bytes);
  }
  return image;
}

absl::StatusOr<PlaneImage> depthPlane(const std::string& file, const Picture& picture,
                                      bool spread) {
  const bool is_rgb = picture.channels >= 3;
  if (is_rgb && meanChannelDifference(picture) > kGreyDifferenceMax) {
    return refuseFile(file,
                      "is coloured; accepted as depth is grey of 8 or 16 bits: save depth without "
                      "a colour map, and check which half of the picture it is in");
  }
  const size_t pixel_count = size_t{picture.width_px} * picture.height_px;
  PlaneImage image{.width_px = picture.width_px,
                   .height_px = picture.height_px,
                   .encoding = v1::PLANE_ENCODING_DEPTH_U16,
                   .has_alpha = false,
                   .bytes = std::vector<uint8_t>(2 * pixel_count)};
  const uint32_t factor = picture.bits == 8 && spread ? 257 : 1;
  image.code_max = picture.bits == 8 && !spread ? 255 : 65535;
  for (size_t pixel = 0; pixel < pixel_count; ++pixel) {
    const size_t at = pixel * picture.channels;
    uint32_t sample = sampleAt(picture, at);
    // Equal channels give just that.
    if (is_rgb) sample = (sample + 2 * sampleAt(picture, at + 1) + sampleAt(picture, at + 2)) / 4;
    const auto stored = static_cast<uint16_t>(factor * sample);
    std::memcpy(&image.bytes[2 * pixel], &stored, sizeof(stored));
  }
  return image;
}

}  // namespace viewloom::files
