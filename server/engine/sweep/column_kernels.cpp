// SPDX-License-Identifier: Apache-2.0
#include "sweep/column_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sweep/column_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sweep/vectors_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

using Halves = hn::Rebind<uint16_t, Floats>;
using HalfFloats = hn::Rebind<hwy::float16_t, Floats>;

// Samples from `x` on; `bytes` go on for a vector.
HWY_INLINE Vec loadSamples(PlaneEncoding encoding, const std::byte* bytes, size_t x) {
  switch (encoding) {
    case PlaneEncoding::kDepthU16: {
      const auto* const values = reinterpret_cast<const uint16_t*>(bytes) + x;
      return hn::ConvertTo(kFloats, hn::PromoteTo(Ints(), hn::LoadU(Halves(), values)));
    }
    case PlaneEncoding::kDepthF16: {
      const auto* const values = reinterpret_cast<const hwy::float16_t*>(bytes) + x;
      const Vec value = hn::PromoteTo(kFloats, hn::LoadU(HalfFloats(), values));
#if HWY_TARGET > HWY_AVX2
      // Without an instruction for it, infinity and NaN are taken for numbers.
      const WordVec bits =
          hn::PromoteTo(kWords, hn::LoadU(Halves(), reinterpret_cast<const uint16_t*>(bytes) + x));
      const WordVec exponent = hn::Set(kWords, 0x7c00U);
      const WordVec special =
          hn::Or(hn::ShiftLeft<13>(hn::And(bits, hn::Set(kWords, 0x3ffU))),
                 hn::Or(hn::Set(kWords, 0x7f800000U),
                        hn::ShiftLeft<16>(hn::And(bits, hn::Set(kWords, 0x8000U)))));
      const auto is_special = hn::Eq(hn::And(bits, exponent), exponent);
      return hn::IfThenElse(hn::RebindMask(kFloats, is_special), hn::BitCast(kFloats, special),
                            value);
#else
      return value;
#endif
    }
    default:
      return hn::LoadU(kFloats, reinterpret_cast<const float*>(bytes) + x);
  }
}

// The members of DepthCoefficients that linearizeRow needs, one copy in each lane.
struct Line {
  explicit Line(const SampleRow& row)
      : coefficients(*row.coefficients),
        origin(set(coefficients.origin)),
        scale(set(coefficients.scale)),
        offset(set(coefficients.offset)),
        inv_z_max(set(coefficients.inv_z_max)),
        invalid_value(set(coefficients.invalid_value)),
        inverse_focal(set(float(1 / row.intrinsics.focal_px.x))),
        principal(set(float(row.intrinsics.principal_px.x - 0.5))) {
    const double ray_y = (row.y + 0.5 - row.intrinsics.principal_px.y) / row.intrinsics.focal_px.y;
    across = set(float(ray_y * ray_y + 1));
  }

  Vec rayLength(size_t x) const {
    const Vec ray_x = hn::Mul(hn::Sub(hn::Iota(kFloats, float(x)), principal), inverse_focal);
    return hn::Sqrt(hn::Add(hn::Mul(ray_x, ray_x), across));
  }

  const DepthCoefficients& coefficients;
  Vec origin, scale, offset, inv_z_max, invalid_value;
  Vec inverse_focal, principal, across;
};

// `bad`: of the samples whose lanes are in `exists`.
HWY_INLINE Vec linearize(const Line& line, Vec sample, size_t x, Mask exists, Mask& bad) {
  const Vec zero = hn::Zero(kFloats);
  const Vec nothing = set(abi::kNoSurface);
  const Vec value = hn::Add(hn::Mul(hn::Sub(sample, line.origin), line.scale), line.offset);
  Vec inv_z = value;
  Mask is_nothing = noLane();
  if (line.coefficients.reciprocal != 0) {
    inv_z = hn::Div(set(1.0F), value);
    if (line.coefficients.ray_distance != 0) inv_z = hn::Mul(inv_z, line.rayLength(x));
    is_nothing = hn::Eq(value, zero);
  }
  const Mask is_good = hn::And(hn::Ge(value, zero), hn::Le(inv_z, line.inv_z_max));
  Vec result = hn::IfThenElse(is_good, inv_z, nothing);
  bad = hn::AndNot(hn::Or(is_good, is_nothing), exists);
  if (line.coefficients.has_invalid != 0) {
    const Mask is_invalid = hn::Eq(sample, line.invalid_value);
    bad = hn::AndNot(is_invalid, bad);
    result =
        hn::IfThenElse(is_invalid, line.coefficients.invalid_is_far != 0 ? zero : nothing, result);
  }
  return result;
}

uint32_t LinearizeRow(const SampleRow& row, float* HWY_RESTRICT inv_z) {
  const Line line(row);
  const size_t lanes = hn::Lanes(kFloats);
  const size_t sample_bytes = row.encoding == PlaneEncoding::kDepthF32 ? 4 : 2;
  size_t bad_count = 0;
  for (size_t x = 0; x < row.width; x += lanes) {
    const size_t count = HWY_MIN(lanes, row.width - x);
    const Mask exists = hn::FirstN(kFloats, count);
    Mask bad = exists;
    if (count == lanes) {
      const Vec sample = loadSamples(row.encoding, row.samples, x);
      hn::StoreU(linearize(line, sample, x, exists, bad), kFloats, inv_z + x);
    } else {
      // Stands in for bytes beyond the plane's end.
      std::byte last[HWY_MAX_BYTES] = {};
      for (size_t i = 0; i < count * sample_bytes; ++i) {
        last[i] = row.samples[x * sample_bytes + i];
      }
      const Vec sample = loadSamples(row.encoding, last, 0);
      hn::StoreU(linearize(line, sample, x, exists, bad), kFloats, inv_z + x);
    }
    bad_count += hn::CountTrue(kFloats, bad);
  }
  return uint32_t(bad_count);
}

HWY_INLINE void exchange(Vec& near, Vec& far) {
  const Vec nearer = hn::Max(near, far);
  far = hn::Min(near, far);
  near = nearer;
}

template <uint32_t kLayers>
struct Kept {
  Kept() : last(set(3.4e38F)), count(hn::Zero(kFloats)) {
    for (Vec& layer : inv_z) layer = set(abi::kNoSurface);
  }

  Vec inv_z[kLayers];
  Vec last;
  Vec count;

  // Adds what is more than one sample's worth behind the last surface.
  void keep(Vec w, const ColumnRow& row) {
    const Vec linear = hn::Add(set(row.format_step.y), hn::Mul(w, set(row.format_step.z)));
    const Vec step = hn::Add(set(row.format_step.x), hn::Mul(w, linear));
    const Mask stays = hn::And(hn::Ge(w, hn::Zero(kFloats)), hn::Gt(hn::Sub(last, w), step));
    for (uint32_t i = 0; i < kLayers; ++i) {
      const Mask is_here = hn::And(stays, hn::Eq(count, set(float(i))));
      inv_z[i] = hn::IfThenElse(is_here, w, inv_z[i]);
    }
    count = hn::Add(count, hn::IfThenElseZero(stays, set(1.0F)));
    last = hn::IfThenElse(stays, w, last);
  }
};

template <uint32_t kLayers>
HWY_INLINE size_t sortVector(const ColumnRow& row, size_t x) {
  Vec column[kLayers];
  // A surface behind a gap counts as in order; one in front of an earlier surface does not.
  Mask is_unsorted = noLane();
  Vec farthest = set(3.4e38F);
  for (uint32_t i = 0; i < kLayers; ++i) {
    column[i] = hn::LoadU(kFloats, row.layers[i] + x);
    is_unsorted = hn::Or(is_unsorted, hn::Gt(column[i], farthest));
    farthest = hn::IfThenElse(hn::Ge(column[i], hn::Zero(kFloats)), column[i], farthest);
  }
  exchange(column[0], column[1]);
  if constexpr (kLayers > 3) exchange(column[2], column[3]);
  if constexpr (kLayers > 2) {
    exchange(column[1], column[2]);
    exchange(column[0], column[1]);
  }
  if constexpr (kLayers > 3) {
    exchange(column[2], column[3]);
    exchange(column[1], column[2]);
  }
  Kept<kLayers> kept;
  for (const Vec& w : column) kept.keep(w, row);
  for (uint32_t i = 0; i < kLayers; ++i) {
    hn::StoreU(kept.inv_z[i], kFloats, row.layers[i] + x);
  }
  const Mask exists = hn::FirstN(kFloats, row.width - x);
  return hn::CountTrue(kFloats, hn::And(is_unsorted, exists));
}

template <uint32_t kLayers>
HWY_INLINE uint32_t sortRow(const ColumnRow& row) {
  size_t unsorted_count = 0;
  for (size_t x = 0; x < row.width; x += hn::Lanes(kFloats)) {
    unsorted_count += sortVector<kLayers>(row, x);
  }
  return uint32_t(unsorted_count);
}

uint32_t SortColumns(const ColumnRow& row) {
  switch (row.layer_count) {
    case 2:
      return sortRow<2>(row);
    case 3:
      return sortRow<3>(row);
    case 4:
      return sortRow<4>(row);
    default:
      return 0;
  }
}

InvZRange RangeOfRow(const float* HWY_RESTRICT inv_z, uint32_t width) {
  const Vec far_out = set(3.4e38F);
  Vec low = far_out;
  Vec high = set(abi::kNoSurface);
  for (size_t x = 0; x < width; x += hn::Lanes(kFloats)) {
    const Mask exists = hn::FirstN(kFloats, width - x);
    const Vec w = hn::IfThenElse(exists, hn::LoadU(kFloats, inv_z + x), set(abi::kNoSurface));
    high = hn::Max(high, w);
    low = hn::Min(low, hn::IfThenElse(hn::Ge(w, hn::Zero(kFloats)), w, far_out));
  }
  return {hn::GetLane(hn::MinOfLanes(kFloats, low)), hn::GetLane(hn::MaxOfLanes(kFloats, high))};
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewloom {

HWY_EXPORT(LinearizeRow);
HWY_EXPORT(SortColumns);
HWY_EXPORT(RangeOfRow);

uint32_t linearizeRow(const SampleRow& row, float* inv_z) {
  return HWY_DYNAMIC_DISPATCH(LinearizeRow)(row, inv_z);
}

uint32_t sortColumns(const ColumnRow& row) {
  return HWY_DYNAMIC_DISPATCH(SortColumns)(row);
}

InvZRange rangeOfRow(const float* inv_z, uint32_t width) {
  return HWY_DYNAMIC_DISPATCH(RangeOfRow)(inv_z, width);
}

}  // namespace viewloom
#endif
