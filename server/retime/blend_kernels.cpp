// SPDX-License-Identifier: Apache-2.0
#include "retime/blend_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "retime/blend_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cstring>

#include "retime/doubles_inl.h"
#include "retime/draw_kernels.h"
#include "shared/structure_abi.h"
#include "sweep/row_source.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// Whole numbers below 2^53 are what they are.
HWY_INLINE DoubleVec toDoubles(LongVec values) {
  const auto words = hn::TruncateTo(HalfWords(), values);
  return hn::PromoteTo(kDoubles, hn::BitCast(HalfInts(), words));
}

HWY_INLINE hn::Vec<HalfInts> toInts(DoubleVec values) {
  return hn::DemoteTo(HalfInts(), values);
}

// Quads that px lie in, a lane each.
struct QuadVector {
  DoubleVec px;        // within the layer, of the sample that it begins at
  DoubleVec x, y;      // likewise
  DoubleVec layer[4];  // of its corners, in the order of Quadrant
};

template <int kShift>
HWY_INLINE DoubleVec layerAt(hn::Vec<HalfInts> quads) {
  return hn::PromoteTo(kDoubles, hn::And(hn::ShiftRight<kShift>(quads), hn::Set(HalfInts(), 3)));
}

// Those of lanes without a quad are somewhere.
HWY_INLINE QuadVector findQuad(const MovedSamples& samples, DoubleVec sample, DoubleMask is_quad) {
  DoubleVec px = sample, layer = hn::Zero(kDoubles);
  for (uint32_t i = 1; i < samples.layer_count; ++i) {
    const DoubleVec first = setDouble(double(i) * samples.areaPx());
    const auto is_here = hn::Ge(sample, first);
    px = hn::IfThenElse(is_here, hn::Sub(sample, first), px);
    layer = hn::IfThenElse(is_here, setDouble(i), layer);
  }
  px = hn::IfThenElseZero(is_quad, px);
  const double width = samples.size_px.width;
  // The middle of a px is further from the ends of its row than any rounding.
  const DoubleVec y = hn::Floor(hn::Mul(hn::Add(px, setDouble(0.5)), setDouble(1 / width)));
  const auto quads = hn::GatherOffset(HalfInts(), reinterpret_cast<const int32_t*>(samples.quads),
                                      toInts(hn::IfThenElseZero(is_quad, sample)));
  return {.px = px,
          .x = hn::Sub(px, hn::Mul(y, setDouble(width))),
          .y = y,
          .layer = {layer, layerAt<0>(quads), layerAt<2>(quads), layerAt<4>(quads)}};
}

// Corners of a triangle, from the px that lies in it.
struct CornerVector {
  DoubleVec sample, x, y;
};

// One after the other, as mostly.
template <class Tag, class Indices>
HWY_INLINE bool areRun(Tag tag, Indices indices) {
  const auto run = hn::Add(hn::Set(tag, hn::GetLane(indices)), hn::Iota(tag, 0));
  return hn::AllTrue(tag, hn::Eq(indices, run));
}

HWY_INLINE DoubleVec gather(const float* values, hn::Vec<HalfInts> indices, bool are_run) {
  if (HWY_LIKELY(are_run)) return loadDoubles(values + hn::GetLane(indices));
  return hn::PromoteTo(kDoubles, hn::GatherIndex(HalfFloats(), values, indices));
}

// The corner of the quad that lies 0 or 1 px to the right of where it begins, and below that.
HWY_INLINE CornerVector cornerAt(const MovedSamples& samples, const QuadVector& quad,
                                 DoubleVec layer, DoubleVec right, DoubleVec below) {
  const DoubleVec half = setDouble(0.5);
  const DoubleVec px =
      hn::Add(hn::Add(quad.px, right), hn::Mul(below, setDouble(samples.size_px.width)));
  const DoubleVec sample = hn::Add(px, hn::Mul(layer, setDouble(samples.areaPx())));
  const auto indices = toInts(sample);
  const bool are_run = areRun(HalfInts(), indices);
  return {
      .sample = sample,
      .x = hn::Add(hn::Add(hn::Add(quad.x, right), half), gather(samples.dx_px, indices, are_run)),
      .y = hn::Add(hn::Add(hn::Add(quad.y, below), half), gather(samples.dy_px, indices, are_run))};
}

// Samples and their shares in px.
struct BlendVector {
  DoubleVec samples[3];
  DoubleVec shares[3];
};

HWY_INLINE BlendVector blendIn(const CornerVector& a, const CornerVector& b, const CornerVector& c,
                               DoubleVec x, DoubleVec y) {
  const DoubleVec area =
      cross(hn::Sub(b.x, a.x), hn::Sub(b.y, a.y), hn::Sub(c.x, a.x), hn::Sub(c.y, a.y));
  const auto shareBetween = [&](const CornerVector& one, const CornerVector& other) HWY_ATTR {
    return hn::Div(
        cross(hn::Sub(one.x, x), hn::Sub(one.y, y), hn::Sub(other.x, x), hn::Sub(other.y, y)),
        area);
  };
  return {.samples = {a.sample, b.sample, c.sample},
          .shares = {shareBetween(b, c), shareBetween(c, a), shareBetween(a, b)}};
}

HWY_INLINE BlendVector blendTriangles(const MovedSamples& samples, DoubleVec sample,
                                      DoubleMask is_upper, DoubleMask is_lower, DoubleVec x,
                                      DoubleVec y) {
  const DoubleVec zero = hn::Zero(kDoubles), one = setDouble(1);
  const auto is_quad = hn::Or(is_upper, is_lower);
  const QuadVector quad = findQuad(samples, sample, is_quad);
  const DoubleVec if_lower = hn::IfThenElseZero(is_lower, one);
  const auto a = cornerAt(samples, quad, hn::IfThenElse(is_lower, quad.layer[1], quad.layer[0]),
                          if_lower, zero);
  const auto b = cornerAt(samples, quad, hn::IfThenElse(is_lower, quad.layer[2], quad.layer[1]),
                          one, if_lower);
  const auto c = cornerAt(samples, quad, quad.layer[3], zero, one);
  BlendVector blend = blendIn(a, b, c, x, y);
  for (uint32_t i = 0; i < 3; ++i) {
    blend.samples[i] = hn::IfThenElse(is_quad, blend.samples[i], sample);
    blend.shares[i] = hn::IfThenElse(is_quad, blend.shares[i], i == 0 ? one : zero);
  }
  return blend;
}

void findVector(const MovedSamples& samples, DoubleVec x, DoubleVec y, LongVec key, uint32_t i,
                BlendedRow& row) {
  const auto is_none = hn::Eq(key, hn::Zero(kLongs));
  const auto inv_z =
      hn::BitCast(HalfFloats(), hn::TruncateTo(HalfWords(), hn::ShiftRight<32>(key)));
  const DoubleVec nothing = setDouble(double{abi::kNoSurface});
  storeFloats(
      hn::IfThenElse(hn::RebindMask(kDoubles, is_none), nothing, hn::PromoteTo(kDoubles, inv_z)),
      row.inv_z.data() + i);
  const LongVec low = hn::Set(kLongs, UINT32_MAX);
  const LongVec piece = hn::IfThenZeroElse(is_none, hn::Sub(low, hn::And(key, low)));
  const LongVec kind = hn::And(piece, hn::Set(kLongs, kPieceKinds - 1));
  const DoubleVec sample = toDoubles(hn::ShiftRight<3>(piece));
  const auto isKind = [&](uint32_t wanted) HWY_ATTR {
    return hn::RebindMask(kDoubles, hn::Eq(kind, hn::Set(kLongs, wanted)));
  };
  const auto is_upper = isKind(kUpperTriangle), is_lower = isKind(kLowerTriangle);
  const DoubleVec zero = hn::Zero(kDoubles);
  BlendVector blend{{sample, sample, sample}, {setDouble(1), zero, zero}};
  if (!hn::AllFalse(kDoubles, hn::Or(is_upper, is_lower))) {
    blend = blendTriangles(samples, sample, is_upper, is_lower, x, y);
  }
  for (uint32_t k = 0; k < 3; ++k) {
    const auto index = hn::BitCast(HalfWords(), toInts(blend.samples[k]));
    hn::StoreU(index, HalfWords(), row.samples[k].data() + i);
    storeFloats(blend.shares[k], row.shares[k].data() + i);
  }
  // The first of those that have as much.
  const auto& [a, b, c] = blend.shares;
  const DoubleVec most = hn::IfThenElse(hn::Gt(b, a), blend.samples[1], blend.samples[0]);
  const DoubleVec main = hn::IfThenElse(hn::Gt(c, hn::Max(a, b)), blend.samples[2], most);
  hn::StoreU(hn::BitCast(HalfWords(), toInts(main)), HalfWords(), row.main.data() + i);
}
static_assert(kPieceKinds == 1 << 3);

void FindBlends(const MovedSamples& samples, uint32_t px, uint32_t count, const uint64_t* keys,
                BlendedRow& row) {
  const double x = px % samples.size_px.width + 0.5;
  const DoubleVec y = setDouble(px / samples.size_px.width + 0.5);
  const auto lanes = uint32_t(hn::Lanes(kLongs));
  for (uint32_t i = 0; i < count; i += lanes) {
    const LongVec key = hn::LoadU(kLongs, keys + i);
    const LongVec those = hn::IfThenElseZero(hn::FirstN(kLongs, count - i), key);
    findVector(samples, hn::Iota(kDoubles, x + i), y, those, i, row);
  }
}

template <int kShift>
HWY_INLINE WordVec blendChannel(const WordVec* texels, const Vec* shares) {
  const auto light = [&](size_t i) HWY_ATTR {
    const WordVec code = hn::And(hn::ShiftRight<kShift>(texels[i]), hn::Set(kWords, 255U));
    return hn::Mul(shares[i], hn::ConvertTo(kFloats, hn::BitCast(kInts, code)));
  };
  const Vec sum = hn::Add(hn::Add(hn::Add(light(0), light(1)), light(2)), set(0.5F));
  const Vec code = hn::Min(hn::Max(sum, hn::Zero(kFloats)), set(255.0F));
  return hn::ShiftLeft<kShift>(hn::BitCast(kWords, hn::ConvertTo(kInts, code)));
}

// Blends samples of several layers.
WordVec pickTexels(const TexelPlanes& planes, const uint32_t* samples, size_t count) {
  HWY_ALIGN uint32_t texels[HWY_MAX_BYTES / sizeof(uint32_t)] = {};
  for (size_t i = 0; i < count; ++i) {
    const uint32_t layer = samples[i] / planes.area_px;
    const size_t px = samples[i] - layer * planes.area_px;
    std::memcpy(texels + i, planes.color[layer] + 4 * px, sizeof texels[i]);
  }
  return hn::Load(kWords, texels);
}

// The texels of a vector of samples; adds the marks of those that have one to `marks`.
HWY_INLINE WordVec loadTexels(const TexelPlanes& planes, const uint32_t* samples, size_t count,
                              WordVec& marks) {
  const WordVec own = hn::LoadU(kWords, samples);
  const uint32_t first_layer = samples[0] / planes.area_px;
  const WordVec area = hn::Set(kWords, planes.area_px);
  const WordVec px = hn::Sub(own, hn::Set(kWords, first_layer * planes.area_px));
  // Samples of layers before the first lane's are large numbers, too.
  const auto is_same = hn::Lt(px, area);
  const bool are_same = count == hn::Lanes(kWords) && hn::AllTrue(kWords, is_same);
  if (HWY_UNLIKELY(!are_same)) {
    for (size_t i = 0; i < count; ++i) {
      if (samples[i] >= planes.area_px || planes.marks[samples[i]] == 0) continue;
      marks = hn::Or(marks, hn::VecFromMask(
                                kWords, hn::Eq(hn::Iota(kWords, 0), hn::Set(kWords, uint32_t(i)))));
    }
    return pickTexels(planes, samples, count);
  }
  const auto* const texels = reinterpret_cast<const uint32_t*>(planes.color[first_layer]);
  const IntVec indices = hn::BitCast(kInts, px);
  if (HWY_LIKELY(areRun(kWords, px))) {
    const size_t begin = hn::GetLane(px);
    if (first_layer == 0) marks = hn::Or(marks, hn::LoadU(kWords, planes.marks + begin));
    return hn::LoadU(kWords, texels + begin);
  }
  if (first_layer == 0) marks = hn::Or(marks, hn::GatherIndex(kWords, planes.marks, indices));
  return hn::GatherIndex(kWords, texels, indices);
}

uint32_t BlendTexels(const TexelPlanes& planes, const BlendedRow& row, uint32_t count,
                     uint8_t* color, uint32_t* marked) {
  const auto lanes = uint32_t(hn::Lanes(kFloats));
  uint32_t marked_count = 0;
  for (uint32_t i = 0; i < count; i += lanes) {
    const uint32_t those = HWY_MIN(lanes, count - i);
    WordVec texels[3];
    Vec shares[3];
    WordVec marks = hn::Zero(kWords);
    for (uint32_t k = 0; k < 3; ++k) {
      texels[k] = loadTexels(planes, row.samples[k].data() + i, those, marks);
      shares[k] = hn::LoadU(kFloats, row.shares[k].data() + i);
    }
    const WordVec sums =
        hn::Or(hn::Or(blendChannel<0>(texels, shares), blendChannel<8>(texels, shares)),
               hn::Or(blendChannel<16>(texels, shares), blendChannel<24>(texels, shares)));
    const Mask exists = hn::And(hn::Ge(hn::LoadU(kFloats, row.inv_z.data() + i), hn::Zero(kFloats)),
                                hn::FirstN(kFloats, those));
    HWY_ALIGN uint32_t rgba[HWY_MAX_BYTES / sizeof(uint32_t)];
    hn::Store(hn::IfThenElseZero(hn::RebindMask(kWords, exists), sums), kWords, rgba);
    std::memcpy(color + size_t{4} * i, rgba, size_t{4} * those);
    const auto is_marked = hn::And(hn::Ne(marks, hn::Zero(kWords)), hn::RebindMask(kWords, exists));
    if (HWY_LIKELY(hn::AllFalse(kWords, is_marked))) continue;
    marked_count += storeThose(kWords, hn::Iota(kWords, i), is_marked, marked + marked_count);
  }
  return marked_count;
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewloom {

HWY_EXPORT(FindBlends);
HWY_EXPORT(BlendTexels);

void BlendedRow::reserve(uint32_t width) {
  inv_z.reserve(width + kRowSlack);
  main.reserve(width + kRowSlack);
  for (uint32_t i = 0; i < 3; ++i) {
    samples[i].reserve(width + kRowSlack);
    shares[i].reserve(width + kRowSlack);
  }
}

void findBlends(const MovedSamples& samples, uint32_t px, uint32_t count, const uint64_t* keys,
                BlendedRow& row) {
  HWY_DYNAMIC_DISPATCH(FindBlends)(samples, px, count, keys, row);
}

uint32_t blendTexels(const TexelPlanes& planes, const BlendedRow& row, uint32_t count,
                     uint8_t* color, uint32_t* marked) {
  return HWY_DYNAMIC_DISPATCH(BlendTexels)(planes, row, count, color, marked);
}

}  // namespace viewloom
#endif
