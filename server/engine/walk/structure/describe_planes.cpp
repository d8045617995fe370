// SPDX-License-Identifier: Apache-2.0
#include "structure/describe_planes.h"

#include <cmath>

#include "frame/depth.h"
#include "shared/tone_map.h"

namespace viewloom {
namespace {

uint32_t sampleType(PlaneEncoding encoding) {
  switch (encoding) {
    case PlaneEncoding::kDepthF16:
      return abi::kDepthSampleF16;
    case PlaneEncoding::kDepthU16:
      return abi::kDepthSampleU16;
    default:
      return abi::kDepthSampleF32;
  }
}

}  // namespace

abi::DepthPlane describeDepth(const PlaneFormat& depth, uint64_t offset_bytes) {
  const DepthCoefficients coefficients = makeDepthCoefficients(depth.depth, depth.encoding);
  const uint32_t type = sampleType(depth.encoding);
  const uint32_t sample_bytes = type == abi::kDepthSampleF32 ? 4 : 2;
  return {.first_sample = uint32_t(offset_bytes / sample_bytes),
          .sample_type = type,
          .origin = coefficients.origin,
          .scale = coefficients.scale,
          .offset = coefficients.offset,
          .invalid_value = coefficients.invalid_value,
          .inv_z_max = coefficients.inv_z_max,
          .reciprocal = coefficients.reciprocal,
          .ray_distance = coefficients.ray_distance,
          .has_invalid = coefficients.has_invalid,
          .invalid_inv_z = coefficients.invalid_is_far != 0 ? 0.0F : abi::kNoSurface};
}

abi::ConvertColorPush describeConversion(const PlaneFormat& color, PlaneEncoding decoded_encoding,
                                         double exposure_ev, ToneMap tone_map) {
  const bool is_linear = color.transfer == ColorTransfer::kLinear;
  return {.from = {},
          .to = {},
          .texel_count = uint32_t(color.size_px.area()),
          .from_format =
              decoded_encoding == PlaneEncoding::kRgba8 ? abi::kColorRgba8 : abi::kColorRgba16f,
          .to_format = abi::kColorRgba16f,
          .is_linear = is_linear,
          .primaries = uint32_t(color.primaries),
          .alpha = uint32_t(color.alpha),
          .light_scale = float(std::exp2(exposure_ev)),
          .tone_map = is_linear ? uint32_t(tone_map) : abi::kToneMapClip};
}

static_assert(uint32_t(ColorPrimaries::kBt709) == abi::kPrimariesBt709);
static_assert(uint32_t(ColorPrimaries::kDisplayP3) == abi::kPrimariesDisplayP3);
static_assert(uint32_t(ColorPrimaries::kBt2020) == abi::kPrimariesBt2020);
static_assert(uint32_t(AlphaMode::kOpaque) == abi::kAlphaOpaque);
static_assert(uint32_t(AlphaMode::kPremultiplied) == abi::kAlphaPremultiplied);
static_assert(uint32_t(AlphaMode::kStraight) == abi::kAlphaStraight);
static_assert(uint32_t(ToneMap::kClip) == abi::kToneMapClip);
static_assert(uint32_t(ToneMap::kFilmic) == abi::kToneMapFilmic);
static_assert(uint32_t(ToneMap::kAgx) == abi::kToneMapAgx);

}  // namespace viewloom
