// SPDX-License-Identifier: Apache-2.0
#include "files/depth_packing.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "base/str_cat.h"
#include "files/file_bytes.h"

namespace viewloom::files {
namespace {

using Rgba = std::array<uint32_t, 4>;

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

// Six ramps of 255 codes around the circle of hues, the last code left out.
constexpr float kHueCodeMax = 1529;

// Colours that are none: the mean code is low, or the channels are nearly alike.
bool isHueless(const Rgba& c) {
  const auto [least, most] = std::minmax({c[0], c[1], c[2]});
  return c[0] + c[1] + c[2] < 128 || most - least < 64;
}

// librealsense, "Depth image compression by colorization": red is 0, green 510, blue 1020.
float depthOfHue(const Rgba& c) {
  if (isHueless(c)) return kNothing;
  const auto [r, g, b] = std::array<int, 3>{int(c[0]), int(c[1]), int(c[2])};
  const int code = r >= g && r >= b ? (g >= b ? g - b : g - b + 1529)
                   : g >= b         ? b - r + 510
                                    : r - g + 1020;
  return static_cast<float>(code) / kHueCodeMax;
}

float share(uint64_t code, uint32_t bits) {
  return static_cast<float>(double(code) / double((uint64_t{1} << bits) - 1));
}

float depthOf(const Rgba& c, v1::DepthPacking packing) {
  switch (packing) {
    case v1::DEPTH_PACKING_RGB24:
      return share(c[0] | c[1] << 8 | c[2] << 16, 24);
    case v1::DEPTH_PACKING_BGR24:
      return share(c[2] | c[1] << 8 | c[0] << 16, 24);
    case v1::DEPTH_PACKING_RGBA32:
      return share(uint64_t{c[0]} << 24 | c[1] << 16 | c[2] << 8 | c[3], 32);
    case v1::DEPTH_PACKING_ABGR32:
      return share(uint64_t{c[3]} << 24 | c[2] << 16 | c[1] << 8 | c[0], 32);
    case v1::DEPTH_PACKING_RG16:
      return share(c[0] << 8 | c[1], 16);
    case v1::DEPTH_PACKING_GR16:
      return share(c[1] << 8 | c[0], 16);
    case v1::DEPTH_PACKING_FLOAT32:
      return std::bit_cast<float>(c[2] | c[1] << 8 | c[0] << 16 | c[3] << 24);
    case v1::DEPTH_PACKING_HUE:
      return depthOfHue(c);
    default:
      return kNothing;
  }
}

bool needsAlpha(v1::DepthPacking packing) {
  return packing == v1::DEPTH_PACKING_RGBA32 || packing == v1::DEPTH_PACKING_ABGR32 ||
         packing == v1::DEPTH_PACKING_FLOAT32;
}

Rgba colorAt(const Picture& picture, size_t pixel) {
  Rgba rgba{0, 0, 0, 255};
  for (size_t i = 0; i < picture.channels; ++i) {
    rgba[i] = picture.bytes[pixel * picture.channels + i];
  }
  return rgba;
}

// How often each channel differs from its left neighbour: the fine digits differ most.
struct Channels {
  std::array<uint64_t, 4> change_count{};
  uint32_t blue_max = 0;
  uint64_t hue_count = 0;  // px of a full hue: one channel at its most, another at 0
};

Channels measure(const Picture& picture) {
  Channels found;
  Rgba before{};
  for (size_t pixel = 0; pixel < picture.pixelCount(); ++pixel) {
    const Rgba rgba = colorAt(picture, pixel);
    const auto [least, most] = std::minmax({rgba[0], rgba[1], rgba[2]});
    if (most > 240 && least < 15) ++found.hue_count;
    for (size_t i = 0; i < 4 && pixel > 0; ++i) found.change_count[i] += rgba[i] != before[i];
    found.blue_max = std::max(found.blue_max, rgba[2]);
    before = rgba;
  }
  return found;
}

// The packing that fits best, of those that a picture may have.
v1::DepthPacking likelyPacking(const Picture& picture) {
  const Channels found = measure(picture);
  const auto& changes = found.change_count;
  if (changes[3] > 0) {
    return changes[3] >= changes[0] ? v1::DEPTH_PACKING_RGBA32 : v1::DEPTH_PACKING_ABGR32;
  }
  if (found.hue_count > picture.pixelCount() / 2) return v1::DEPTH_PACKING_HUE;
  if (found.blue_max == 0) {
    return changes[0] <= changes[1] ? v1::DEPTH_PACKING_RG16 : v1::DEPTH_PACKING_GR16;
  }
  return changes[0] >= changes[2] ? v1::DEPTH_PACKING_RGB24 : v1::DEPTH_PACKING_BGR24;
}

}  // namespace

const char* nameOf(v1::DepthPacking packing) {
  switch (packing) {
    case v1::DEPTH_PACKING_RGB24:
      return "rgb24";
    case v1::DEPTH_PACKING_BGR24:
      return "bgr24";
    case v1::DEPTH_PACKING_RGBA32:
      return "rgba32";
    case v1::DEPTH_PACKING_ABGR32:
      return "abgr32";
    case v1::DEPTH_PACKING_RG16:
      return "rg16";
    case v1::DEPTH_PACKING_GR16:
      return "gr16";
    case v1::DEPTH_PACKING_FLOAT32:
      return "float32";
    case v1::DEPTH_PACKING_HUE:
      return "hue";
    default:
      return "none";
  }
}

double codeMaxOf(v1::DepthPacking packing) {
  switch (packing) {
    case v1::DEPTH_PACKING_RGB24:
    case v1::DEPTH_PACKING_BGR24:
      return (1 << 24) - 1;
    case v1::DEPTH_PACKING_RGBA32:
    case v1::DEPTH_PACKING_ABGR32:
      return double{UINT32_MAX};
    case v1::DEPTH_PACKING_RG16:
    case v1::DEPTH_PACKING_GR16:
      return 65535;
    default:
      return 1;
  }
}

absl::StatusOr<Picture> unpackDepth(const std::string& file, const Picture& picture,
                                    v1::DepthPacking packing) {
  const uint32_t wanted = needsAlpha(packing) ? 4 : 3;
  if (picture.bits != 8 || picture.channels < wanted) {
    return refuseFile(file, strCat("has ", picture.channels, " channels of ", picture.bits,
                                   " bits; --depth-packing ", nameOf(packing), " takes ",
                                   wanted == 4 ? "RGBA" : "RGB",
                                   " of 8 bits: leave the option out for "
                                   "depth that is grey"));
  }
  Picture depth{.width_px = picture.width_px,
                .height_px = picture.height_px,
                .channels = 1,
                .bits = 32,
                .code_max = packing == v1::DEPTH_PACKING_FLOAT32 ? 0U : 1U,
                .coding = {},
                .bytes = {}};
  depth.bytes.resize(4 * depth.pixelCount());
  for (size_t pixel = 0; pixel < depth.pixelCount(); ++pixel) {
    const float sample = depthOf(colorAt(picture, pixel), packing);
    std::memcpy(&depth.bytes[4 * pixel], &sample, sizeof(sample));
  }
  return depth;
}

std::string adviceForColor(const Picture& picture) {
  constexpr char kStart[] =
      "is coloured; accepted as depth is grey of 8 or 16 bits, or floats: save depth without a "
      "colour map";
  if (picture.bits != 8) return strCat(kStart, ", and check which half of it is depth");
  const v1::DepthPacking packing = likelyPacking(picture);
  const char* const scale = packing == v1::DEPTH_PACKING_HUE
                                ? " --depth-near METRES --depth-far METRES"
                            : packing == v1::DEPTH_PACKING_RGB24
                                ? " (CARLA: white is 1000 m, others with --depth-scale METRES)"
                                : " --depth-scale METRES-AT-WHITE";
  return strCat(kStart, "; if its channels are digits of the depth, give --depth-packing ",
                nameOf(packing), scale,
                "; if it is the colour picture, or depth is in its other half, check "
                "--depth and --depth-side");
}

}  // namespace viewloom::files
