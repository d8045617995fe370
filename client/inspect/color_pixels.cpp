// SPDX-License-Identifier: Apache-2.0
#include "inspect/color_pixels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include <glm/gtc/packing.hpp>

#include "base/srgb.h"
#include "files/jpeg_image.h"

namespace viewloom::inspect {
namespace {

uint8_t codeFromLinear(float linear) {
  const float clipped = std::clamp(linear, 0.0F, 1.0F);
  return static_cast<uint8_t>(std::lround(255 * srgbFromLinear(clipped)));
}

}  // namespace

absl::StatusOr<ColorPixels> ColorPixels::open(v1::Plane plane, const std::vector<uint8_t>& bytes) {
  ColorPixels pixels(std::move(plane), bytes);
  if (pixels.plane_.encoding() != v1::PLANE_ENCODING_JPEG) return pixels;
  absl::StatusOr<files::Picture> picture = files::decodeJpeg("colour", bytes);
  if (!picture.ok()) return picture.status();
  pixels.decoded_ = std::move(picture->bytes);
  pixels.plane_.set_encoding(v1::PLANE_ENCODING_RGB8);
  return pixels;
}

Rgb ColorPixels::at(double x_share, double y_share) const {
  const auto x = static_cast<size_t>(x_share * plane_.size().width());
  const auto y = static_cast<size_t>(y_share * plane_.size().height());
  const size_t index = y * plane_.size().width() + x;
  if (plane_.encoding() == v1::PLANE_ENCODING_RGBA16F) return linearAt(8 * index);
  const size_t pixel_bytes = plane_.encoding() == v1::PLANE_ENCODING_RGBA8 ? 4 : 3;
  const uint8_t* const pixel = &bytes()[pixel_bytes * index];
  return {pixel[0], pixel[1], pixel[2]};
}

Rgb ColorPixels::linearAt(size_t offset) const {
  std::array<uint16_t, 3> halves{};
  std::memcpy(halves.data(), &bytes()[offset], sizeof(halves));
  Rgb rgb{};
  for (size_t i = 0; i < 3; ++i) rgb[i] = codeFromLinear(glm::unpackHalf1x16(halves[i]));
  return rgb;
}

}  // namespace viewloom::inspect
