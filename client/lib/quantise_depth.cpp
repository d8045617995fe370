// SPDX-License-Identifier: Apache-2.0
#include "lib/quantise_depth.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "base/str_cat.h"
#include "lib/inverse_depth.h"

namespace viewloom {
namespace {

constexpr uint16_t kNoSurface = 0;
constexpr uint16_t kFarthest = 1;
constexpr uint16_t kNearest = 65535;
// Displays may show a source larger than it is.
constexpr double kFocalMin_px = 1000;
// Steps of binary32 itself, one of the number and one of a division.
constexpr double kRelativeStepMin = 0x1p-22;
constexpr size_t kPercentileSamples = 1 << 16;
constexpr double kStepMin = 1e-20;  // 1/m; nothing but sky needs none, but has to have one

struct DepthPlane {
  v1::Plane* declared = nullptr;
  SharedBytes* bytes = nullptr;
  std::vector<float> inv_z;
};

// 1/Z = inv_z_min + (code - kFarthest) step
struct Grid {
  double inv_z_min = 0;
  double step = 0;
  double invZMax() const { return inv_z_min + (kNearest - kFarthest) * step; }
};

// The step is a binary32 number, as servers compute with those: so it loses nothing there.
Grid gridOver(double inv_z_min, double inv_z_max) {
  const auto stepOver = [&](double from) {
    const double step = std::max(
        {(inv_z_max - from) / (kNearest - kFarthest), inv_z_max * kRelativeStepMin, kStepMin});
    const auto rounded = static_cast<float>(step);
    return double{rounded < step ? std::nextafter(rounded, 1.0F) : rounded};
  };
  const double step = stepOver(inv_z_min);
  // So near to the sky, rounding could put it behind.
  if (inv_z_min < step) return {0, stepOver(0)};
  return {inv_z_min, step};
}

// Floats that are not negative order as their bits do, which are compared many at a time; negative
// ones, no surfaces, are the largest of unsigned bits and the smallest of signed ones.
Grid gridOf(const std::vector<DepthPlane>& planes) {
  uint32_t least_bits = std::bit_cast<uint32_t>(kNoInvZ);
  int32_t most_bits = 0;
  for (const DepthPlane& plane : planes) {
    for (const float inv_z : plane.inv_z) {
      least_bits = std::min(least_bits, std::bit_cast<uint32_t>(inv_z));
      most_bits = std::max(most_bits, std::bit_cast<int32_t>(inv_z));
    }
  }
  const float inv_z_max = std::bit_cast<float>(most_bits);
  return gridOver(std::max(std::bit_cast<float>(least_bits), 0.0F), inv_z_max);
}

std::vector<uint8_t> codesOf(const DepthPlane& plane, const Grid& grid) {
  const double steps_per_unit = 1 / grid.step;
  // Rounds half up; truncation is what many can be done with at a time.
  const double first = kFarthest + 0.5 - grid.inv_z_min * steps_per_unit;
  std::vector<uint16_t> codes(plane.inv_z.size());
  for (size_t i = 0; i < codes.size(); ++i) {
    const double inv_z = std::max(double{plane.inv_z[i]}, grid.inv_z_min);
    const auto code = static_cast<int32_t>(inv_z * steps_per_unit + first);
    codes[i] = plane.inv_z[i] < 0 ? kNoSurface : static_cast<uint16_t>(code);
  }
  std::vector<uint8_t> out(codes.size() * sizeof(uint16_t));
  std::memcpy(out.data(), codes.data(), out.size());
  return out;
}

// Where displays focus, 1/m: half way between the 2nd and the 98th percentile of what is nearer
// than the sky. 0 = there is nothing.
double focalInvZ(const std::vector<DepthPlane>& planes) {
  std::vector<float> surfaces;
  for (const DepthPlane& plane : planes) {
    // Odd: not the same columns of every row.
    const size_t stride = (plane.inv_z.size() / kPercentileSamples) | 1;
    for (size_t i = 0; i < plane.inv_z.size(); i += stride) {
      if (plane.inv_z[i] > 0) surfaces.push_back(plane.inv_z[i]);
    }
  }
  if (surfaces.empty()) return 0;
  const auto quantile = [&](double share) {
    const auto index = static_cast<std::ptrdiff_t>(share * double(surfaces.size() - 1));
    std::nth_element(surfaces.begin(), surfaces.begin() + index, surfaces.end());
    return double{surfaces[static_cast<size_t>(index)]};
  };
  return 0.5 * (quantile(0.02) + quantile(0.98));
}

void replace(DepthPlane& plane, const Grid& grid, std::vector<uint8_t> codes) {
  v1::Plane& declared = *plane.declared;
  declared.set_encoding(v1::PLANE_ENCODING_DEPTH_U16);
  declared.set_stride_bytes(0);
  declared.set_bytes_count(codes.size());
  v1::DepthFormat format;
  format.set_meaning(v1::DEPTH_MEANING_DISPARITY);
  format.set_scale(grid.step);
  format.set_offset(grid.inv_z_min - kFarthest * grid.step);
  format.set_invalid_value(kNoSurface);
  *declared.mutable_depth() = format;
  *plane.bytes = std::make_shared<const std::vector<uint8_t>>(std::move(codes));
}

bool isPlainF32(const v1::Plane& plane) {
  return plane.encoding() == v1::PLANE_ENCODING_DEPTH_F32 &&
         plane.compression() <= v1::PLANE_COMPRESSION_NONE;
}

}  // namespace

QuantisedDepth quantiseDepth(v1::Source& source, std::span<SharedBytes> planes) {
  std::vector<DepthPlane> depths;
  size_t index = 0;
  for (v1::Layer& layer : *source.mutable_layers()) {
    for (v1::Plane& plane : *layer.mutable_planes()) {
      SharedBytes& bytes = planes[index++];
      if (isPlainF32(plane)) depths.push_back({.declared = &plane, .bytes = &bytes, .inv_z = {}});
    }
  }
  if (depths.empty()) return {};
  const std::optional<Intrinsics> intrinsics = depthIntrinsics(source);
  for (DepthPlane& depth : depths) {
    auto inv_z = intrinsics
                     ? inverseDepth(*depth.declared, **depth.bytes, *intrinsics, source.cube_map())
                     : std::nullopt;
    if (!inv_z) return {.kept_because = "its format is incomplete, or no server accepts it"};
    depth.inv_z = *std::move(inv_z);
  }
  const Grid grid = gridOf(depths);
  const double focal_px = std::max({intrinsics->focal_px.x, intrinsics->focal_px.y, kFocalMin_px});
  const double focal_inv_z = focalInvZ(depths);
  const double step_max = focal_inv_z > 0 ? focal_inv_z / focal_px : grid.step;
  if (grid.step > step_max) {
    return {.step_max = step_max,
            .kept_because = strCat("16 bits from ", grid.inv_z_min, " to ", grid.invZMax(),
                                   " 1/m are steps of ", grid.step, " 1/m; steps above ", step_max,
                                   " would show")};
  }
  for (DepthPlane& depth : depths) replace(depth, grid, codesOf(depth, grid));
  return {.step = grid.step, .step_max = step_max, .kept_because = {}};
}

}  // namespace viewloom
