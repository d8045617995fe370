// SPDX-License-Identifier: Apache-2.0
#include "files/picture.h"

#include <Imath/half.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/srgb.h"
#include "base/str_cat.h"
#include "files/depth_packing.h"
#include "files/file_bytes.h"
#include "files/plane_image.h"

namespace viewloom::files {
namespace {

// Mean difference between channels, as a share of the largest sample. JPEG gives grey a thousandth,
// colour maps of depth are beyond a tenth.
constexpr double kGreyDifferenceMax = 0.02;

bool hasAlpha(const Picture& picture) {
  return picture.channels == 2 || picture.channels == 4;
}

// Sample of red, green, blue or alpha; grey counts as each colour. 1 without alpha.
float colorAt(const Picture& picture, size_t pixel, size_t channel, float white) {
  if (channel == 3 && !hasAlpha(picture)) return 1;
  const size_t stored = channel == 3 ? picture.channels - 1 : picture.channels < 3 ? 0 : channel;
  return picture.sampleAt(pixel * picture.channels + stored) / white;
}

std::vector<uint8_t> halfRgba(const Picture& picture, const ToneCurve& curve) {
  const size_t pixel_count = picture.pixelCount();
  const float white = picture.bits == 32 ? 1 : static_cast<float>(picture.whiteCode());
  std::vector<uint8_t> bytes(8 * pixel_count);
  for (size_t pixel = 0; pixel < pixel_count; ++pixel) {
    std::array<uint16_t, 4> rgba{};
    for (size_t channel = 0; channel < 4; ++channel) {
      const float stored = colorAt(picture, pixel, channel, white);
      const float light = channel == 3 ? stored : curve.light(stored);
      const float finite = std::isnan(light) ? 0 : std::clamp(light, -kHalfMax, kHalfMax);
      rgba[channel] = Imath::half(finite).bits();
    }
    std::memcpy(&bytes[8 * pixel], rgba.data(), 8);
  }
  return bytes;
}

// RGB8 or RGBA8. Codes of other curves than sRGB and linear are coded anew as sRGB.
std::vector<uint8_t> byteColor(Picture picture, const ToneCurve& curve) {
  const bool is_kept = curve.isLinear() || curve.isSrgb();
  if (is_kept && picture.channels >= 3 && picture.whiteCode() == 255) {
    return std::move(picture.bytes);
  }
  std::array<uint8_t, 256> colors{}, alphas{};
  for (size_t code = 0; code < colors.size(); ++code) {
    const float share = std::min(1.0F, static_cast<float>(code) / float(picture.whiteCode()));
    alphas[code] = static_cast<uint8_t>(std::lround(255 * share));
    const double coded = is_kept ? share : srgbFromLinear(curve.light(share));
    colors[code] = static_cast<uint8_t>(std::lround(255 * coded));
  }
  const size_t stored = picture.channels, made = hasAlpha(picture) ? 4 : 3;
  std::vector<uint8_t> bytes(made * picture.pixelCount());
  for (size_t pixel = 0; pixel < picture.pixelCount(); ++pixel) {
    const uint8_t* const in = &picture.bytes[stored * pixel];
    uint8_t* const out = &bytes[made * pixel];
    for (size_t i = 0; i < 3; ++i) out[i] = colors[in[stored < 3 ? 0 : i]];
    if (made == 4) out[3] = alphas[in[stored - 1]];
  }
  return bytes;
}

// Between the colours of a picture with three channels or more.
double meanChannelDifference(const Picture& picture) {
  const size_t pixel_count = picture.pixelCount();
  double sum = 0, most_of_all = picture.bits == 32 ? 1e-30 : picture.whiteCode();
  for (size_t pixel = 0; pixel < pixel_count; ++pixel) {
    const size_t at = pixel * picture.channels;
    const auto [least, most] =
        std::minmax({picture.sampleAt(at), picture.sampleAt(at + 1), picture.sampleAt(at + 2)});
    if (std::isfinite(most) && std::isfinite(least)) sum += double{most} - double{least};
    if (std::isfinite(most)) most_of_all = std::max(most_of_all, std::abs(double{most}));
  }
  return sum / (static_cast<double>(pixel_count) * most_of_all);
}

// The sample of depth: equal channels give just that.
float depthAt(const Picture& picture, size_t pixel) {
  const size_t at = pixel * picture.channels;
  if (picture.channels < 3 || picture.bits == 32) return picture.sampleAt(at);
  const auto code = [&](size_t index) { return static_cast<uint32_t>(picture.sampleAt(index)); };
  return static_cast<float>((code(at) + 2 * code(at + 1) + code(at + 2)) / 4);
}

}  // namespace

float Picture::sampleAt(size_t index) const {
  if (bits == 8) return bytes[index];
  if (bits == 16) {
    uint16_t value = 0;
    std::memcpy(&value, &bytes[2 * index], sizeof(value));
    return value;
  }
  float value = 0;
  std::memcpy(&value, &bytes[4 * index], sizeof(value));
  return value;
}

absl::StatusOr<Picture> cutPart(const std::string& file, Picture picture, v1::ImagePart part) {
  if (part == v1::IMAGE_PART_UNSPECIFIED) return picture;
  const bool beside = part == v1::IMAGE_PART_LEFT || part == v1::IMAGE_PART_RIGHT;
  if ((beside ? picture.width_px : picture.height_px) % 2 != 0) {
    return refuseFile(file, strCat("is ", picture.width_px, "x", picture.height_px,
                                   " px; halves need an even ", beside ? "width" : "height"));
  }
  const uint32_t width_px = beside ? picture.width_px / 2 : picture.width_px;
  const uint32_t height_px = beside ? picture.height_px : picture.height_px / 2;
  const size_t pixel_bytes = picture.pixelBytes();
  const size_t row_bytes = pixel_bytes * picture.width_px;
  const size_t first_x = part == v1::IMAGE_PART_RIGHT ? width_px : 0;
  const size_t first_y = part == v1::IMAGE_PART_BOTTOM ? height_px : 0;
  std::vector<uint8_t> cut(pixel_bytes * width_px * height_px);
  for (size_t y = 0; y < height_px; ++y) {
    std::memcpy(&cut[y * pixel_bytes * width_px],
                &picture.bytes[(first_y + y) * row_bytes + first_x * pixel_bytes],
                pixel_bytes * width_px);
  }
  picture.width_px = width_px;
  picture.height_px = height_px;
  picture.bytes = std::move(cut);
  return picture;
}

// Exif's orientations, as the place in the stored picture of a px of the upright one:
//   1 as stored, 2 mirrored, 3 half a turn, 4 mirrored and half a turn,
//   5 to 8 the same with columns and rows exchanged first
Picture turned(Picture picture, uint32_t orientation) {
  if (orientation <= 1 || orientation > 8) return picture;
  const bool is_exchanged = orientation >= 5;
  const bool from_right =
      orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
  const bool from_bottom =
      orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
  const size_t width = is_exchanged ? picture.height_px : picture.width_px;
  const size_t height = is_exchanged ? picture.width_px : picture.height_px;
  const size_t pixel_bytes = picture.pixelBytes();
  std::vector<uint8_t> upright(picture.bytes.size());
  for (size_t y = 0; y < height; ++y) {
    for (size_t x = 0; x < width; ++x) {
      const size_t along = is_exchanged ? y : x, down = is_exchanged ? x : y;
      const size_t stored_x = from_right ? picture.width_px - 1 - along : along;
      const size_t stored_y = from_bottom ? picture.height_px - 1 - down : down;
      std::memcpy(&upright[pixel_bytes * (y * width + x)],
                  &picture.bytes[pixel_bytes * (stored_y * picture.width_px + stored_x)],
                  pixel_bytes);
    }
  }
  picture.width_px = static_cast<uint32_t>(width);
  picture.height_px = static_cast<uint32_t>(height);
  picture.bytes = std::move(upright);
  return picture;
}

void flipRows(std::vector<uint8_t>& bytes, size_t height_px) {
  const auto row_bytes = static_cast<std::ptrdiff_t>(bytes.size() / height_px);
  const auto height = static_cast<std::ptrdiff_t>(height_px);
  for (std::ptrdiff_t y = 0; y < height / 2; ++y) {
    const auto upper = bytes.begin() + y * row_bytes;
    std::swap_ranges(upper, upper + row_bytes, bytes.begin() + (height - 1 - y) * row_bytes);
  }
}

PlaneImage colorPlane(Picture picture, v1::ColorTransfer transfer) {
  const bool is_float = picture.bits == 32;
  const ToneCurve curve(transfer, picture.coding,
                        is_float ? v1::COLOR_TRANSFER_LINEAR : v1::COLOR_TRANSFER_SRGB);
  const std::optional<Imf::Chromaticities> chromaticities = picture.coding.chromaticities();
  PlaneImage image{.width_px = picture.width_px,
                   .height_px = picture.height_px,
                   .encoding = v1::PLANE_ENCODING_RGBA16F,
                   .has_alpha = hasAlpha(picture),
                   .is_premultiplied = picture.coding.is_premultiplied,
                   .code_max = is_float ? 0 : picture.whiteCode(),
                   .chromaticities = chromaticities,
                   .bytes = {}};
  if (picture.bits != 8 || (chromaticities && !knownPrimaries(*chromaticities))) {
    image.bytes = halfRgba(picture, curve);
    return image;
  }
  image.encoding = image.has_alpha ? v1::PLANE_ENCODING_RGBA8 : v1::PLANE_ENCODING_RGB8;
  if (curve.isLinear()) image.transfer = v1::COLOR_TRANSFER_LINEAR;
  image.bytes = byteColor(std::move(picture), curve);
  return image;
}

absl::StatusOr<PlaneImage> depthPlane(const std::string& file, const Picture& picture,
                                      bool spread) {
  if (picture.channels >= 3 && meanChannelDifference(picture) > kGreyDifferenceMax) {
    return refuseFile(file, adviceForColor(picture));
  }
  const size_t pixel_count = picture.pixelCount();
  PlaneImage image{.width_px = picture.width_px,
                   .height_px = picture.height_px,
                   .encoding = v1::PLANE_ENCODING_DEPTH_U16,
                   .code_max = picture.bits == 32 ? picture.code_max : picture.whiteCode(),
                   .bytes = {}};
  const uint32_t white = picture.whiteCode();
  if (picture.bits == 32 || (spread && white != 255 && white != 65535)) {
    const float unit = picture.bits == 32 ? 1 : static_cast<float>(white);
    image.encoding = v1::PLANE_ENCODING_DEPTH_F32;
    image.bytes.resize(4 * pixel_count);
    for (size_t pixel = 0; pixel < pixel_count; ++pixel) {
      const float stored = depthAt(picture, pixel) / unit;
      std::memcpy(&image.bytes[4 * pixel], &stored, sizeof(stored));
    }
    return image;
  }
  const uint32_t factor = white == 255 && spread ? 257 : 1;
  if (factor != 1) image.code_max = 65535;
  image.bytes.resize(2 * pixel_count);
  for (size_t pixel = 0; pixel < pixel_count; ++pixel) {
    const auto stored = static_cast<uint16_t>(factor * uint32_t(depthAt(picture, pixel)));
    std::memcpy(&image.bytes[2 * pixel], &stored, sizeof(stored));
  }
  return image;
}

}  // namespace viewloom::files
