// SPDX-License-Identifier: Apache-2.0
#include "photos/color_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

namespace viewloom::photos {
namespace {

using Xyz = std::array<double, 3>;
using Colorants = std::array<Xyz, 3>;  // red, green, blue

struct Known {
  v1::ColorPrimaries primaries;
  Colorants colorants;
};

// Each primary's share of white D65, adapted (Bradford) to the D50 in which ICC profiles count.
constexpr std::array<Known, 3> kKnown{
    {{v1::COLOR_PRIMARIES_BT709,
      {{{0.4360, 0.2225, 0.0139}, {0.3851, 0.7169, 0.0971}, {0.1430, 0.0606, 0.7139}}}},
     {v1::COLOR_PRIMARIES_DISPLAY_P3,
      {{{0.5151, 0.2412, -0.0011}, {0.2920, 0.6922, 0.0419}, {0.1571, 0.0666, 0.7841}}}},
     {v1::COLOR_PRIMARIES_BT2020,
      {{{0.6735, 0.2790, -0.0019}, {0.1657, 0.6753, 0.0300}, {0.1250, 0.0456, 0.7969}}}}}};

// Of X, Y or Z of white. Profiles differ by the digits of D65 and D50 that they were made with, up
// to 0.001; the nearest two of the above differ by 0.02.
constexpr double kSame = 0.002;

constexpr size_t kHeaderBytes = 128;
constexpr size_t kTagBytes = 12;

// Big endian; 0 beyond the end.
uint32_t numberAt(std::span<const uint8_t> bytes, size_t offset) {
  if (offset > bytes.size() || bytes.size() - offset < 4) return 0;
  return uint32_t{bytes[offset]} << 24 | uint32_t{bytes[offset + 1]} << 16 |
         uint32_t{bytes[offset + 2]} << 8 | bytes[offset + 3];
}

constexpr uint32_t signature(std::string_view name) {
  uint32_t code = 0;
  for (const char c : name) code = code << 8 | static_cast<uint8_t>(c);
  return code;
}

std::optional<Xyz> xyzOfTag(std::span<const uint8_t> profile, uint32_t name) {
  const size_t count = numberAt(profile, kHeaderBytes);
  for (size_t i = 0; i < count; ++i) {
    const size_t tag = kHeaderBytes + 4 + kTagBytes * i;
    if (tag >= profile.size()) return std::nullopt;
    if (numberAt(profile, tag) != name) continue;
    const size_t value = numberAt(profile, tag + 4);
    if (numberAt(profile, value) != signature("XYZ ")) return std::nullopt;
    Xyz xyz{};
    for (size_t axis = 0; axis < 3; ++axis) {  // s15Fixed16Number
      xyz[axis] = static_cast<int32_t>(numberAt(profile, value + 8 + 4 * axis)) / 65536.0;
    }
    return xyz;
  }
  return std::nullopt;
}

bool isSame(const Xyz& a, const Xyz& b) {
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](double its, double other) { return std::abs(its - other) <= kSame; });
}

// Code points of ITU-T H.273.
std::optional<v1::ColorPrimaries> primariesOfNclx(int code) {
  switch (code) {
    case heif_color_primaries_ITU_R_BT_709_5:
      return v1::COLOR_PRIMARIES_BT709;
    case heif_color_primaries_ITU_R_BT_2020_2_and_2100_0:
      return v1::COLOR_PRIMARIES_BT2020;
    case heif_color_primaries_SMPTE_EG_432_1:
      return v1::COLOR_PRIMARIES_DISPLAY_P3;
    default:
      return std::nullopt;
  }
}

ColorProfile nclxProfileOf(const heif_image_handle* image) {
  heif_color_profile_nclx* found = nullptr;
  if (heif_image_handle_get_nclx_color_profile(image, &found).code != heif_error_Ok) return {};
  const HeifOwned<heif_color_profile_nclx> nclx(found);
  if (nclx == nullptr) return {};
  const int transfer = nclx->transfer_characteristics;
  return {.is_stated = nclx->color_primaries != heif_color_primaries_unspecified,
          .primaries = primariesOfNclx(nclx->color_primaries),
          .is_hdr = transfer == heif_transfer_characteristic_ITU_R_BT_2100_0_PQ ||
                    transfer == heif_transfer_characteristic_ITU_R_BT_2100_0_HLG};
}

}  // namespace

std::optional<v1::ColorPrimaries> primariesOfIcc(std::span<const uint8_t> profile) {
  Colorants colorants{};
  constexpr std::array<std::string_view, 3> kNames{"rXYZ", "gXYZ", "bXYZ"};
  for (size_t i = 0; i < 3; ++i) {
    const std::optional<Xyz> xyz = xyzOfTag(profile, signature(kNames[i]));
    if (!xyz) return std::nullopt;
    colorants[i] = *xyz;
  }
  for (const Known& known : kKnown) {
    if (std::equal(colorants.begin(), colorants.end(), known.colorants.begin(), isSame)) {
      return known.primaries;
    }
  }
  return std::nullopt;
}

ColorProfile colorProfileOf(const heif_image_handle* image) {
  const ColorProfile nclx = nclxProfileOf(image);
  std::vector<uint8_t> icc(heif_image_handle_get_raw_color_profile_size(image));
  if (icc.empty() ||
      heif_image_handle_get_raw_color_profile(image, icc.data()).code != heif_error_Ok) {
    return nclx;
  }
  return {.is_stated = true, .primaries = primariesOfIcc(icc), .is_hdr = nclx.is_hdr};
}

}  // namespace viewloom::photos
