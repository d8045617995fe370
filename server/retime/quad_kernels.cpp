// SPDX-License-Identifier: Apache-2.0
#include "retime/quad_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "retime/quad_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cmath>
#include <cstring>

#include "sweep/link_kernels.h"
#include "sweep/vectors_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

using AllBytes = hn::ScalableTag<uint8_t>;
using ByteVec = hn::Vec<AllBytes>;
constexpr AllBytes kBytes;

HWY_INLINE ByteVec setByte(uint8_t value) {
  return hn::Set(kBytes, value);
}

QuadLayers quadAt(const LinkedRows& rows, uint32_t layer, uint32_t x) {
  const uint8_t right = rows.to_right[layer][x], below = rows.to_below[layer][x];
  if (isSilhouette(right) || isSilhouette(below)) return 0;
  const uint8_t last = rows.to_below[right - 1U][x + 1];
  if (isSilhouette(last) || rows.to_right_below[below - 1U][x] != last) return 0;
  return quadOf(right - 1U, last - 1U, below - 1U);
}

// Nearly all quads lie on one layer.
void FindQuads(const LinkedRows& rows, uint32_t first, uint32_t end,
               const ByLayer<QuadLayers*>& quads) {
  for (uint32_t layer = 0; layer < rows.layer_count; ++layer) {
    const uint8_t* const right = rows.to_right[layer];
    const uint8_t* const below = rows.to_below[layer];
    const uint8_t* const right_below = rows.to_right_below[layer];
    const ByteVec own = setByte(uint8_t(layer + 1));
    uint32_t x = first;
    for (; x + hn::Lanes(kBytes) <= end; x += uint32_t(hn::Lanes(kBytes))) {
      const auto is_flat = hn::And(hn::And(hn::Eq(hn::LoadU(kBytes, right + x), own),
                                           hn::Eq(hn::LoadU(kBytes, below + x), own)),
                                   hn::And(hn::Eq(hn::LoadU(kBytes, below + x + 1), own),
                                           hn::Eq(hn::LoadU(kBytes, right_below + x), own)));
      hn::StoreU(hn::IfThenElseZero(is_flat, setByte(flatQuad(layer))), kBytes, quads[layer] + x);
      if (HWY_LIKELY(hn::AllTrue(kBytes, is_flat))) continue;
      for (uint32_t i = x; i < x + hn::Lanes(kBytes); ++i) {
        if (quads[layer][i] == 0) quads[layer][i] = quadAt(rows, layer, i);
      }
    }
    for (; x < end; ++x) quads[layer][x] = quadAt(rows, layer, x);
  }
}

// Neighbours that move apart, or into each other, by more than this are two things that only
// touched: what is left between them is not theirs.
constexpr float kTorn_px = 1;

bool isTorn(const MovedSamples& samples, uint32_t a, uint32_t b) {
  return !(samples.inv_z[b] >= 0 && std::abs(samples.dx_px[a] - samples.dx_px[b]) <= kTorn_px &&
           std::abs(samples.dy_px[a] - samples.dy_px[b]) <= kTorn_px);
}

QuadLayers drawnQuad(const MovedSamples& samples, uint32_t sample, QuadLayers quad) {
  const uint32_t area = samples.areaPx();
  if (quad == 0 || !(samples.inv_z[sample] >= 0)) return 0;
  const auto [a, b, c, d] = samples.cornersOf(quad, sample / area, sample % area);
  const bool moves =
      (samples.moves[a] | samples.moves[b] | samples.moves[c] | samples.moves[d]) != 0;
  const bool is_torn = isTorn(samples, a, b) || isTorn(samples, a, d) || isTorn(samples, b, c) ||
                       isTorn(samples, d, c);
  return moves && !is_torn ? quad : QuadLayers{0};
}

HWY_INLINE Mask areNear(const float* values, uint32_t a, uint32_t b) {
  return hn::Le(hn::Abs(hn::Sub(hn::LoadU(kFloats, values + a), hn::LoadU(kFloats, values + b))),
                set(kTorn_px));
}

HWY_INLINE Mask areWhole(const float* values, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  return hn::And(hn::And(areNear(values, a, b), areNear(values, a, d)),
                 hn::And(areNear(values, b, c), areNear(values, d, c)));
}

HWY_INLINE Mask exists(const float* inv_z, uint32_t sample) {
  return hn::Ge(hn::LoadU(kFloats, inv_z + sample), hn::Zero(kFloats));
}

HWY_INLINE hn::Vec<Bytes> loadBytes(const uint8_t* bytes) {
  return hn::LoadU(Bytes(), bytes);
}

void KeepDrawnQuads(const MovedSamples& samples, uint32_t sample, uint32_t count,
                    const QuadLayers* quads, QuadLayers* drawn) {
  const uint32_t width = samples.size_px.width;
  const auto lanes = uint32_t(hn::Lanes(kFloats));
  const QuadLayers flat = flatQuad(sample / samples.areaPx());
  uint32_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const uint32_t a = sample + i, b = a + 1, c = b + width, d = a + width;
    const auto quad = loadBytes(quads + i);
    const auto is_flat = hn::Eq(quad, hn::Set(Bytes(), flat));
    const auto is_none = hn::Eq(quad, hn::Zero(Bytes()));
    if (HWY_UNLIKELY(!hn::AllTrue(Bytes(), hn::Or(is_flat, is_none)))) {
      for (uint32_t k = 0; k < lanes; ++k) drawn[i + k] = drawnQuad(samples, a + k, quads[i + k]);
      continue;
    }
    const Mask exist = hn::And(hn::And(exists(samples.inv_z, a), exists(samples.inv_z, b)),
                               hn::And(exists(samples.inv_z, c), exists(samples.inv_z, d)));
    const Mask stays = hn::And(
        exist, hn::And(areWhole(samples.dx_px, a, b, c, d), areWhole(samples.dy_px, a, b, c, d)));
    const auto moving = hn::Or(hn::Or(loadBytes(samples.moves + a), loadBytes(samples.moves + b)),
                               hn::Or(loadBytes(samples.moves + c), loadBytes(samples.moves + d)));
    const IntVec kept = hn::IfThenElseZero(hn::RebindMask(kInts, stays), hn::Set(kInts, 0xff));
    const auto is_drawn = hn::And(hn::DemoteTo(Bytes(), kept), hn::Sub(hn::Zero(Bytes()), moving));
    hn::StoreU(hn::And(quad, is_drawn), Bytes(), drawn + i);
  }
  for (; i < count; ++i) drawn[i] = drawnQuad(samples, sample + i, quads[i]);
}

// The corner of the quad that a sample is, is the other side of the sample's own footprint.
HWY_INLINE ByteVec sideOf(const QuadLayers* quads, ByteVec flat, Quadrant side) {
  return hn::IfThenElseZero(hn::Eq(hn::LoadU(kBytes, quads), flat), setByte(side));
}

// By flat quads.
void coverFlat(const MovedSamples& samples, uint32_t y, uint32_t layer, uint32_t first,
               uint32_t end, uint8_t* covered) {
  const uint32_t width = samples.size_px.width;
  const QuadLayers flat = flatQuad(layer);
  const auto sidesAt = [&](uint32_t s) HWY_ATTR {
    const QuadLayers* const quads = samples.quads + s;
    const ByteVec all = setByte(flat);
    ByteVec sides = hn::Or(sideOf(quads, all, kBottomRight), sideOf(quads - 1, all, kBottomLeft));
    if (y > 0) {
      sides = hn::Or(sides, hn::Or(sideOf(quads - width, all, kTopRight),
                                   sideOf(quads - width - 1, all, kTopLeft)));
    }
    const auto moves = hn::Eq(hn::LoadU(kBytes, samples.moves + s), setByte(1));
    return hn::IfThenElse(moves, sides, setByte(kAllQuadrants));
  };
  const auto lanes = uint32_t(hn::Lanes(kBytes));
  const uint32_t row = samples.sampleAt(layer, 0, y);
  for (uint32_t x = first; x < end; x += lanes) {
    uint8_t sides[HWY_MAX_BYTES];
    hn::StoreU(sidesAt(row + x), kBytes, sides);
    std::memcpy(covered + row + x, sides, HWY_MIN(lanes, end - x));
  }
}

// By those of the row that begin at row `begins_at`, and lie on several layers.
void coverBent(const MovedSamples& samples, uint32_t y, uint32_t begins_at, uint32_t layer,
               uint32_t first, uint32_t end, uint8_t* covered) {
  const uint32_t row = samples.sampleAt(layer, 0, begins_at);
  const QuadLayers flat = flatQuad(layer);
  const auto isBent = [&](uint32_t x) {
    const QuadLayers quad = samples.quads[row + x];
    return quad != 0 && quad != flat;
  };
  const auto lanes = uint32_t(hn::Lanes(kBytes));
  for (uint32_t begin = first; begin < end; begin += lanes) {
    const ByteVec quads = hn::LoadU(kBytes, samples.quads + row + begin);
    const auto is_plain = hn::Or(hn::Eq(quads, hn::Zero(kBytes)), hn::Eq(quads, setByte(flat)));
    if (HWY_LIKELY(hn::AllTrue(kBytes, is_plain))) continue;
    for (uint32_t x = begin; x < HWY_MIN(begin + lanes, end); ++x) {
      if (!isBent(x)) continue;
      const uint32_t px = begins_at * samples.size_px.width + x;
      const auto corners = samples.cornersOf(samples.quads[row + x], layer, px);
      if (begins_at == y) {
        covered[corners[0]] |= kBottomRight;
        covered[corners[1]] |= kBottomLeft;
      } else {
        covered[corners[2]] |= kTopLeft;
        covered[corners[3]] |= kTopRight;
      }
    }
  }
}

void CoverQuadrants(const MovedSamples& samples, uint32_t y, uint32_t first, uint32_t end,
                    uint8_t* covered) {
  for (uint32_t layer = 0; layer < samples.layer_count; ++layer) {
    coverFlat(samples, y, layer, first, end, covered);
  }
  const uint32_t begin = first > 0 ? first - 1 : 0;
  for (uint32_t layer = 0; layer < samples.layer_count; ++layer) {
    coverBent(samples, y, y, layer, begin, end, covered);
    if (y > 0) coverBent(samples, y, y - 1, layer, begin, end, covered);
  }
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewloom {

HWY_EXPORT(FindQuads);
HWY_EXPORT(KeepDrawnQuads);
HWY_EXPORT(CoverQuadrants);

void findQuads(const LinkedRows& rows, uint32_t first, uint32_t end,
               const ByLayer<QuadLayers*>& quads) {
  HWY_DYNAMIC_DISPATCH(FindQuads)(rows, first, end, quads);
}

void keepDrawnQuads(const MovedSamples& samples, uint32_t sample, uint32_t count,
                    const QuadLayers* quads, QuadLayers* drawn) {
  HWY_DYNAMIC_DISPATCH(KeepDrawnQuads)(samples, sample, count, quads, drawn);
}

void coverQuadrants(const MovedSamples& samples, uint32_t y, uint32_t first, uint32_t end,
                    uint8_t* covered) {
  HWY_DYNAMIC_DISPATCH(CoverQuadrants)(samples, y, first, end, covered);
}

}  // namespace viewloom
#endif
