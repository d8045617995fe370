// SPDX-License-Identifier: Apache-2.0
#include "files/plane_image.h"

#include <Imath/ImathMatrix.h>
#include <Imath/half.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <exception>

#include "base/str_cat.h"
#include "files/file_bytes.h"

namespace viewloom::files {

absl::Status checkPlaneSize(const std::string& file, int64_t width_px, int64_t height_px) {
  if (width_px >= 1 && height_px >= 1 && width_px <= kSideMax_px && height_px <= kSideMax_px) {
    return absl::OkStatus();
  }
  return refuseFile(file, strCat("is ", width_px, "x", height_px, " px; accepted is 1..",
                                 kSideMax_px, " a side"));
}

namespace {

// Files state primaries with three or four digits.
constexpr float kSame = 0.0015F;

struct Known {
  v1::ColorPrimaries primaries;
  Imf::Chromaticities chromaticities;
};

const std::array<Known, 3>& knownOnes() {
  using Imath::V2f;
  static const V2f d65(0.3127F, 0.3290F);
  static const std::array<Known, 3> known{
      {{v1::COLOR_PRIMARIES_BT709,
        {V2f(0.640F, 0.330F), V2f(0.300F, 0.600F), V2f(0.150F, 0.060F), d65}},
       {v1::COLOR_PRIMARIES_DISPLAY_P3,
        {V2f(0.680F, 0.320F), V2f(0.265F, 0.690F), V2f(0.150F, 0.060F), d65}},
       {v1::COLOR_PRIMARIES_BT2020,
        {V2f(0.708F, 0.292F), V2f(0.170F, 0.797F), V2f(0.131F, 0.046F), d65}}}};
  return known;
}

bool isSame(const Imath::V2f& a, const Imath::V2f& b) {
  return std::abs(a.x - b.x) <= kSame && std::abs(a.y - b.y) <= kSame;
}

// Vectors are rows, as everywhere in Imath.
Imath::M33d upper(const Imath::M44f& matrix) {
  Imath::M33d result;
  for (int i = 0; i < 9; ++i) result[i / 3][i % 3] = double{matrix[i / 3][i % 3]};
  return result;
}

Imath::V3d whiteXyz(const Imf::Chromaticities& chromaticities) {
  const double x = double{chromaticities.white.x}, y = double{chromaticities.white.y};
  return {x / y, 1, (1 - x - y) / y};
}

// Adapts XYZ from one white to another, by the cone responses of Bradford.
Imath::M33d adaptation(const Imath::V3d& from_white, const Imath::V3d& to_white) {
  const Imath::M33d cones(0.8951, -0.7502, 0.0389, 0.2664, 1.7135, -0.0685, -0.1614, 0.0367,
                          1.0296);
  const Imath::V3d from = from_white * cones;
  const Imath::V3d to = to_white * cones;
  const Imath::M33d gains(to.x / from.x, 0, 0, 0, to.y / from.y, 0, 0, 0, to.z / from.z);
  return cones * gains * cones.inverse();
}

bool isFinite(const Imath::M33d& matrix) {
  return std::all_of(matrix.getValue(), matrix.getValue() + 9,
                     [](double value) { return std::isfinite(value) && std::abs(value) < 1e3; });
}

void convert(const Imath::M33d& matrix, std::vector<uint8_t>& rgba16f) {
  for (size_t at = 0; at < rgba16f.size(); at += 8) {
    std::array<Imath::half, 3> rgb;
    std::memcpy(static_cast<void*>(rgb.data()), &rgba16f[at], 6);
    const Imath::V3d converted =
        Imath::V3d(double{float{rgb[0]}}, double{float{rgb[1]}}, double{float{rgb[2]}}) * matrix;
    for (size_t i = 0; i < 3; ++i) {
      const auto value = static_cast<float>(converted[static_cast<int>(i)]);
      rgb[i] = Imath::half(std::clamp(value, -kHalfMax, kHalfMax));
    }
    std::memcpy(&rgba16f[at], rgb.data(), 6);
  }
}

}  // namespace

std::optional<v1::ColorPrimaries> knownPrimaries(const Imf::Chromaticities& chromaticities) {
  for (const Known& known : knownOnes()) {
    const Imf::Chromaticities& its = known.chromaticities;
    if (isSame(chromaticities.red, its.red) && isSame(chromaticities.green, its.green) &&
        isSame(chromaticities.blue, its.blue) && isSame(chromaticities.white, its.white)) {
      return known.primaries;
    }
  }
  return std::nullopt;
}

absl::StatusOr<v1::ColorPrimaries> settlePrimaries(const std::string& file,
                                                   const Imf::Chromaticities& stated,
                                                   std::vector<uint8_t>& rgba16f) {
  if (const auto known = knownPrimaries(stated)) return *known;
  const absl::Status refusal = refuseFile(
      file, "has chromaticities that span no colours; state the primaries instead, as bt709");
  try {
    const Imf::Chromaticities& target = knownOnes().back().chromaticities;
    const Imath::M33d xyz_from_file = upper(Imf::RGBtoXYZ(stated, 1));
    const Imath::M33d target_from_xyz = upper(Imf::RGBtoXYZ(target, 1)).inverse();
    const Imath::M33d matrix =
        xyz_from_file * adaptation(whiteXyz(stated), whiteXyz(target)) * target_from_xyz;
    if (!isFinite(matrix) || std::abs(matrix.determinant()) < 1e-6) return refusal;
    convert(matrix, rgba16f);
  } catch (const std::exception&) {  // Imf::RGBtoXYZ divides by what is 0
    return refusal;
  }
  return v1::COLOR_PRIMARIES_BT2020;
}

absl::StatusOr<v1::ColorPrimaries> settlePrimaries(const std::string& file, PlaneImage& image) {
  if (!image.chromaticities) return v1::COLOR_PRIMARIES_BT709;
  return settlePrimaries(file, *image.chromaticities, image.bytes);
}

}  // namespace viewloom::files
