// SPDX-License-Identifier: Apache-2.0
#include "retime/draw_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "retime/draw_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include "retime/doubles_inl.h"
#include "shared/structure_abi.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// Share of a triangle by which a px may lie outside of it and count: rounding, so that px on the
// edge between two belong to one at least.
constexpr double kEdgeSlack = 1e-6;
// The same in px, of the largest that are drawn: more than theirs.
constexpr double kEdgeSlack_px = 1e-4;

struct Corner {
  DoubleVec x, y, inv_z;
};

// Quads, a lane each: their corners in the order of Quadrant.
struct QuadVector {
  Corner corners[4];
  LongVec first_piece;
  DoubleMask is_drawn;
};

// A px to the right and below, of each corner.
constexpr double kCornerX[4] = {0, 1, 1, 0};
constexpr double kCornerY[4] = {0, 0, 1, 1};

HWY_INLINE Corner placeCorner(uint32_t corner, double x, double y, DoubleVec dx, DoubleVec dy,
                              DoubleVec inv_z) {
  return {.x = hn::Add(hn::Iota(kDoubles, x + kCornerX[corner] + 0.5), dx),
          .y = hn::Add(setDouble(y + kCornerY[corner] + 0.5), dy),
          .inv_z = inv_z};
}

// All on one layer: one after the other.
HWY_INLINE void loadFlat(const MovedSamples& samples, uint32_t sample, double x, double y,
                         QuadVector& quads) {
  const uint32_t width = samples.size_px.width;
  const uint32_t corners[4] = {sample, sample + 1, sample + width + 1, sample + width};
  for (uint32_t i = 0; i < 4; ++i) {
    quads.corners[i] = placeCorner(i, x, y, loadDoubles(samples.dx_px + corners[i]),
                                   loadDoubles(samples.dy_px + corners[i]),
                                   loadDoubles(samples.inv_z + corners[i]));
  }
}

// Across layers.
void loadBent(const MovedSamples& samples, uint32_t layer, uint32_t px, double x, double y,
              QuadVector& quads) {
  float values[3][4][HWY_MAX_BYTES / sizeof(double)];
  for (uint32_t lane = 0; lane < hn::Lanes(kDoubles); ++lane) {
    const uint32_t sample = layer * samples.areaPx() + px + lane;
    const QuadLayers quad = samples.quads[sample];
    const auto corners = quad == 0 ? std::array{sample, sample, sample, sample}
                                   : samples.cornersOf(quad, layer, px + lane);
    for (uint32_t i = 0; i < 4; ++i) {
      values[0][i][lane] = samples.dx_px[corners[i]];
      values[1][i][lane] = samples.dy_px[corners[i]];
      values[2][i][lane] = samples.inv_z[corners[i]];
    }
  }
  for (uint32_t i = 0; i < 4; ++i) {
    quads.corners[i] = placeCorner(i, x, y, loadDoubles(values[0][i]), loadDoubles(values[1][i]),
                                   loadDoubles(values[2][i]));
  }
}

// Half of a quad; offers it to px.
struct TriangleVector {
  TriangleVector(const Corner& corner_a, const Corner& corner_b, const Corner& corner_c)
      : a(corner_a), b(corner_b), c(corner_c) {
    const DoubleVec area =
        cross(hn::Sub(b.x, a.x), hn::Sub(b.y, a.y), hn::Sub(c.x, a.x), hn::Sub(c.y, a.y));
    has_area = hn::Ne(area, hn::Zero(kDoubles));
    per_area = hn::Div(setDouble(1), area);
  }

  const Corner& a;
  const Corner& b;
  const Corner& c;
  DoubleMask has_area;
  DoubleVec per_area;
};

HWY_INLINE DoubleVec leastOf4(const Corner* corners, DoubleVec Corner::*axis) {
  return hn::Min(hn::Min(corners[0].*axis, corners[1].*axis),
                 hn::Min(corners[2].*axis, corners[3].*axis));
}
HWY_INLINE DoubleVec mostOf4(const Corner* corners, DoubleVec Corner::*axis) {
  return hn::Max(hn::Max(corners[0].*axis, corners[1].*axis),
                 hn::Max(corners[2].*axis, corners[3].*axis));
}

// Px whose middles lie between two places, within the image.
struct PxRange {
  PxRange(DoubleVec low_px, DoubleVec high_px, uint32_t size_px) {
    const DoubleVec last_px = setDouble(double(size_px) - 1);
    const DoubleVec begin = hn::Ceil(hn::Sub(low_px, setDouble(0.5 + kEdgeSlack_px)));
    const DoubleVec end = hn::Floor(hn::Add(high_px, setDouble(kEdgeSlack_px - 0.5)));
    first = hn::Max(begin, hn::Zero(kDoubles));
    last = hn::Min(end, last_px);
  }
  // The most of those lanes, from the first to the last.
  HWY_INLINE int count(DoubleMask those) const {
    const DoubleVec counts = hn::Sub(last, first);
    // Places far outside would not fit an integer.
    const DoubleVec inside = hn::Max(hn::IfThenElse(those, counts, setDouble(-1)), setDouble(-1));
    return int(hn::GetLane(hn::MaxOfLanes(kDoubles, inside))) + 1;
  }

  DoubleVec first, last;
};

HWY_INLINE LongVec keysOf(DoubleVec inv_z, LongVec pieces) {
  // Never -0, whose bits would be the largest.
  const auto rounded = hn::Add(hn::Max(hn::DemoteTo(HalfFloats(), inv_z), hn::Zero(HalfFloats())),
                               hn::Zero(HalfFloats()));
  const LongVec bits = hn::PromoteTo(kLongs, hn::BitCast(HalfWords(), rounded));
  return hn::Or(hn::ShiftLeft<32>(bits), hn::Sub(hn::Set(kLongs, UINT32_MAX), pieces));
}

// Those lanes. One by one: Highway's compression of so wide lanes looks its order up in a table,
// which g++ copies each time.
HWY_INLINE void append(LongVec px, LongVec keys, DoubleMask those, Fragments& fragments) {
  HWY_ALIGN uint64_t all_px[HWY_MAX_BYTES / sizeof(uint64_t)];
  HWY_ALIGN uint64_t all_keys[HWY_MAX_BYTES / sizeof(uint64_t)];
  uint8_t bits[8] = {};
  hn::Store(px, kLongs, all_px);
  hn::Store(keys, kLongs, all_keys);
  hn::StoreMaskBits(kDoubles, those, bits);
  for (uint32_t left = bits[0]; left != 0; left &= left - 1) {
    const auto lane = uint32_t(std::countr_zero(left));
    fragments.px[fragments.count] = all_px[lane];
    fragments.keys[fragments.count] = all_keys[lane];
    ++fragments.count;
  }
}

// From a px to the corners of quads.
struct Rays {
  DoubleVec x[4], y[4];
};

// To the lanes whose triangle the px lies in. `i`, `j`, `k`: the triangle's corners.
HWY_INLINE void offer(const QuadVector& quads, const Rays& rays, const TriangleVector& triangle,
                      uint32_t i, uint32_t j, uint32_t k, DoubleMask those, uint32_t kind,
                      LongVec px, Fragments& fragments) {
  const DoubleVec least = setDouble(-kEdgeSlack);
  const auto share = [&](uint32_t a, uint32_t b) HWY_ATTR {
    return hn::Mul(cross(rays.x[a], rays.y[a], rays.x[b], rays.y[b]), triangle.per_area);
  };
  const DoubleVec of_i = share(j, k), of_j = share(k, i), of_k = share(i, j);
  const auto is_inside = hn::And(hn::And(those, hn::Ge(of_i, least)),
                                 hn::And(hn::Ge(of_j, least), hn::Ge(of_k, least)));
  if (hn::AllFalse(kDoubles, is_inside)) return;
  const DoubleVec inv_z =
      hn::Add(hn::Add(hn::Mul(of_i, quads.corners[i].inv_z), hn::Mul(of_j, quads.corners[j].inv_z)),
              hn::Mul(of_k, quads.corners[k].inv_z));
  const LongVec keys = keysOf(inv_z, hn::Add(quads.first_piece, hn::Set(kLongs, kind)));
  append(px, keys, is_inside, fragments);
}

HWY_INLINE LongVec toLongs(DoubleVec values) {
  return hn::PromoteTo(kLongs, hn::BitCast(HalfWords(), hn::DemoteTo(HalfInts(), values)));
}

void drawVector(const MovedSamples& samples, const QuadVector& quads, Fragments& fragments) {
  const Corner* const corners = quads.corners;
  const TriangleVector upper(corners[0], corners[1], corners[3]);
  const TriangleVector lower(corners[1], corners[2], corners[3]);
  const DoubleMask is_upper = hn::And(quads.is_drawn, upper.has_area);
  const DoubleMask is_lower = hn::And(quads.is_drawn, lower.has_area);
  const PxRange columns(leastOf4(corners, &Corner::x), mostOf4(corners, &Corner::x),
                        samples.size_px.width);
  const PxRange rows(leastOf4(corners, &Corner::y), mostOf4(corners, &Corner::y),
                     samples.size_px.height);
  const int column_count = columns.count(quads.is_drawn), row_count = rows.count(quads.is_drawn);
  for (int j = 0; j < row_count; ++j) {
    const DoubleVec y = hn::Add(rows.first, setDouble(j));
    for (int i = 0; i < column_count; ++i) {
      const DoubleVec x = hn::Add(columns.first, setDouble(i));
      const auto exists = hn::And(hn::Le(x, columns.last), hn::Le(y, rows.last));
      const DoubleVec at_x = hn::Add(x, setDouble(0.5)), at_y = hn::Add(y, setDouble(0.5));
      Rays rays;
      for (uint32_t corner = 0; corner < 4; ++corner) {
        rays.x[corner] = hn::Sub(corners[corner].x, at_x);
        rays.y[corner] = hn::Sub(corners[corner].y, at_y);
      }
      const LongVec px = toLongs(hn::Add(hn::Mul(y, setDouble(samples.size_px.width)), x));
      offer(quads, rays, upper, 0, 1, 3, hn::And(exists, is_upper), kUpperTriangle, px, fragments);
      offer(quads, rays, lower, 1, 2, 3, hn::And(exists, is_lower), kLowerTriangle, px, fragments);
    }
  }
}

void DrawQuads(const MovedSamples& samples, uint32_t layer, uint32_t px, uint32_t count,
               Fragments& fragments) {
  fragments.count = 0;
  const uint32_t sample = layer * samples.areaPx() + px;
  const auto lanes = uint32_t(hn::Lanes(kDoubles));
  const double x = px % samples.size_px.width, y = px / samples.size_px.width;
  const LongVec none = hn::Zero(kLongs);
  for (uint32_t i = 0; i < count; i += lanes) {
    const LongVec layers = loadLongs(samples.quads + sample + i);
    const auto is_one = hn::AndNot(hn::Eq(layers, none), hn::FirstN(kLongs, count - i));
    if (hn::AllFalse(kLongs, is_one)) continue;
    QuadVector quads;
    quads.is_drawn = hn::RebindMask(kDoubles, is_one);
    quads.first_piece = hn::ShiftLeft<3>(hn::Iota(kLongs, sample + i));
    const auto is_bent = hn::AndNot(hn::Eq(layers, hn::Set(kLongs, flatQuad(layer))), is_one);
    if (HWY_LIKELY(hn::AllFalse(kLongs, is_bent))) {
      loadFlat(samples, sample + i, x + i, y, quads);
    } else {
      loadBent(samples, layer, px + i, x + i, y, quads);
    }
    drawVector(samples, quads, fragments);
  }
}
static_assert(kPieceKinds == 1 << 3);

template <uint32_t kLayers>
HWY_INLINE void drawStillVector(const MovedSamples& samples, uint32_t px, Vec in_front,
                                uint64_t* keys) {
  Vec nearest = set(abi::kNoSurface);
  WordVec piece = hn::Set(kWords, UINT32_MAX);
  for (uint32_t layer = 0; layer < kLayers; ++layer) {
    const uint32_t sample = layer * samples.areaPx() + px;
    const Vec inv_z = hn::LoadU(kFloats, samples.inv_z + sample);
    const IntVec moves = hn::PromoteTo(kInts, hn::LoadU(Bytes(), samples.moves + sample));
    const Mask stands = hn::RebindMask(kFloats, hn::Eq(moves, hn::Zero(kInts)));
    const Mask is_nearest =
        hn::And(hn::And(stands, hn::Lt(inv_z, in_front)), hn::Gt(inv_z, nearest));
    nearest = hn::IfThenElse(is_nearest, inv_z, nearest);
    const WordVec own = hn::ShiftLeft<3>(hn::Iota(kWords, sample));
    piece = hn::IfThenElse(hn::RebindMask(kWords, is_nearest), own, piece);
  }
  const Mask is_one = hn::Ge(nearest, hn::Zero(kFloats));
  const Vec inv_z = hn::IfThenElseZero(is_one, hn::Add(nearest, hn::Zero(kFloats)));
  // The low half of a key lies first in memory.
  hn::StoreInterleaved2(hn::Sub(hn::Set(kWords, UINT32_MAX), piece), hn::BitCast(kWords, inv_z),
                        kWords, reinterpret_cast<uint32_t*>(keys));
}

template <uint32_t kLayers>
HWY_INLINE void drawStillOf(const MovedSamples& samples, uint32_t px, uint32_t count,
                            const float* in_front, uint64_t* keys) {
  // Without a layer before it, all are behind it.
  const Vec all = set(3.4e38F);
  const auto lanes = uint32_t(hn::Lanes(kFloats));
  uint32_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const Vec limit = in_front != nullptr ? hn::LoadU(kFloats, in_front + px + i) : all;
    drawStillVector<kLayers>(samples, px + i, limit, keys + i);
  }
  if (i == count) return;
  float last_in_front[HWY_MAX_BYTES / sizeof(float)] = {};
  uint64_t last_keys[HWY_MAX_BYTES / sizeof(float)];
  if (in_front != nullptr) std::copy(in_front + px + i, in_front + px + count, last_in_front);
  const Vec limit = in_front != nullptr ? hn::LoadU(kFloats, last_in_front) : all;
  drawStillVector<kLayers>(samples, px + i, limit, last_keys);
  std::copy_n(last_keys, count - i, keys + i);
}

void DrawStill(const MovedSamples& samples, uint32_t px, uint32_t count, const float* in_front,
               uint64_t* keys) {
  VIEWLOOM_BY_LAYER_COUNT(samples.layer_count, drawStillOf, samples, px, count, in_front, keys)
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewloom {

HWY_EXPORT(DrawQuads);
HWY_EXPORT(DrawStill);

void drawQuads(const MovedSamples& samples, uint32_t layer, uint32_t px, uint32_t count,
               Fragments& fragments) {
  HWY_DYNAMIC_DISPATCH(DrawQuads)(samples, layer, px, count, fragments);
}

void drawStill(const MovedSamples& samples, uint32_t px, uint32_t count, const float* in_front,
               uint64_t* keys) {
  HWY_DYNAMIC_DISPATCH(DrawStill)(samples, px, count, in_front, keys);
}

}  // namespace viewloom
#endif
