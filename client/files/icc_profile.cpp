// SPDX-License-Identifier: Apache-2.0
#include "files/icc_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace viewloom::files {
namespace {

using Xyz = std::array<double, 3>;
using Colorants = std::array<Xyz, 3>;  // red, green, blue

struct Known {
  v1::ColorPrimaries primaries;  // UNSPECIFIED: none of the wire's
  Colorants colorants;
  std::array<float, 6> xy;  // red, green, blue; white is D65
};

// Each primary's share of white D65, adapted (Bradford) to the D50 in which ICC profiles count.
constexpr std::array<Known, 4> kKnown{
    {{v1::COLOR_PRIMARIES_BT709,
      {{{0.4360, 0.2225, 0.0139}, {0.3851, 0.7169, 0.0971}, {0.1430, 0.0606, 0.7139}}},
      {0.640F, 0.330F, 0.300F, 0.600F, 0.150F, 0.060F}},
     {v1::COLOR_PRIMARIES_DISPLAY_P3,
      {{{0.5151, 0.2412, -0.0011}, {0.2920, 0.6922, 0.0419}, {0.1571, 0.0666, 0.7841}}},
      {0.680F, 0.320F, 0.265F, 0.690F, 0.150F, 0.060F}},
     {v1::COLOR_PRIMARIES_BT2020,
      {{{0.6735, 0.2790, -0.0019}, {0.1657, 0.6753, 0.0300}, {0.1250, 0.0456, 0.7969}}},
      {0.708F, 0.292F, 0.170F, 0.797F, 0.131F, 0.046F}},
     {v1::COLOR_PRIMARIES_UNSPECIFIED,  // Adobe RGB
      {{{0.6097, 0.3111, 0.0195}, {0.2053, 0.6257, 0.0609}, {0.1492, 0.0632, 0.7446}}},
      {0.640F, 0.330F, 0.210F, 0.710F, 0.150F, 0.060F}}}};

// Tolerance for X, Y or Z of white. Profiles were made with different digits of D65 and D50, up to
// 0.001 apart; the nearest two of the above differ by 0.02.
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

// Where the value of a tag begins; nothing without the tag.
std::optional<size_t> valueOfTag(std::span<const uint8_t> profile, uint32_t name) {
  const size_t count = numberAt(profile, kHeaderBytes);
  for (size_t i = 0; i < count; ++i) {
    const size_t tag = kHeaderBytes + 4 + kTagBytes * i;
    if (tag >= profile.size()) return std::nullopt;
    if (numberAt(profile, tag) == name) return numberAt(profile, tag + 4);
  }
  return std::nullopt;
}

// s15Fixed16Number.
double fixedAt(std::span<const uint8_t> profile, size_t offset) {
  return static_cast<int32_t>(numberAt(profile, offset)) / 65536.0;
}

std::optional<Xyz> xyzOfTag(std::span<const uint8_t> profile, uint32_t name) {
  const std::optional<size_t> value = valueOfTag(profile, name);
  if (!value || numberAt(profile, *value) != signature("XYZ ")) return std::nullopt;
  Xyz xyz{};
  for (size_t axis = 0; axis < 3; ++axis) xyz[axis] = fixedAt(profile, *value + 8 + 4 * axis);
  return xyz;
}

// The power of a tone curve: light = stored ^ power.
std::optional<double> powerOfTag(std::span<const uint8_t> profile, uint32_t name) {
  const std::optional<size_t> value = valueOfTag(profile, name);
  if (!value) return std::nullopt;
  if (numberAt(profile, *value) == signature("para")) {
    // Other types have a straight part near black; their power says less than that of sRGB.
    const bool is_power = numberAt(profile, *value + 8) >> 16 == 0;
    return is_power ? std::optional(fixedAt(profile, *value + 12)) : std::nullopt;
  }
  if (numberAt(profile, *value) != signature("curv")) return std::nullopt;
  const size_t count = numberAt(profile, *value + 8);
  const auto entry = [&](size_t i) { return numberAt(profile, *value + 12 + 2 * i) >> 16; };
  if (count == 0) return 1;
  if (count == 1) return entry(0) / 256.0;
  const double middle = entry(count / 2) / 65535.0;
  if (!(middle > 0 && middle < 1)) return std::nullopt;
  return std::log(middle) / std::log(double(count / 2) / double(count - 1));
}

bool isSame(const Xyz& a, const Xyz& b) {
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](double its, double other) { return std::abs(its - other) <= kSame; });
}

const Known* knownOfIcc(std::span<const uint8_t> profile) {
  Colorants colorants{};
  constexpr std::array<std::string_view, 3> kNames{"rXYZ", "gXYZ", "bXYZ"};
  for (size_t i = 0; i < 3; ++i) {
    const std::optional<Xyz> xyz = xyzOfTag(profile, signature(kNames[i]));
    if (!xyz) return nullptr;
    colorants[i] = *xyz;
  }
  for (const Known& known : kKnown) {
    if (std::equal(colorants.begin(), colorants.end(), known.colorants.begin(), isSame)) {
      return &known;
    }
  }
  return nullptr;
}

}  // namespace

std::optional<v1::ColorPrimaries> primariesOfIcc(std::span<const uint8_t> profile) {
  const Known* const known = knownOfIcc(profile);
  if (known == nullptr || known->primaries == v1::COLOR_PRIMARIES_UNSPECIFIED) {
    return std::nullopt;
  }
  return known->primaries;
}

ColorCoding codingOfIcc(std::span<const uint8_t> profile) {
  ColorCoding coding;
  if (const Known* const known = knownOfIcc(profile)) {
    coding.has_chromaticities = true;
    std::copy(known->xy.begin(), known->xy.end(), coding.xy.begin());
    coding.xy[6] = 0.3127F;
    coding.xy[7] = 0.3290F;
  }
  const auto power = powerOfTag(profile, signature("rTRC"));
  const auto grey = power ? power : powerOfTag(profile, signature("kTRC"));
  if (grey && *grey > 0.1 && *grey < 10) coding.gamma = 1 / *grey;
  return coding;
}

}  // namespace viewloom::files
