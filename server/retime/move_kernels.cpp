// SPDX-License-Identifier: Apache-2.0
#include "retime/move_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "retime/move_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstring>

#include "frame/depth.h"
#include "retime/doubles_inl.h"
#include "shared/structure_abi.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// Columns that are moved at a time, in a cache: a whole number of any CPU's vectors.
constexpr uint32_t kChunk_px = 64;
constexpr uint32_t kAxes = 3;

struct Chunk {
  HWY_ALIGN uint16_t motion[kAxes * kChunk_px] = {};
  HWY_ALIGN float speed[kAxes][kChunk_px];
  HWY_ALIGN float dx_px[kChunk_px];
  HWY_ALIGN float dy_px[kChunk_px];
  HWY_ALIGN float inv_z[kChunk_px];
  uint8_t moves[kChunk_px];
};

// Motion is finite.
void loadSpeed(const MotionRow& row, uint32_t x, uint32_t count, Chunk& chunk) {
  constexpr hn::CappedTag<uint16_t, kChunk_px> kAllHalves;
  std::memcpy(chunk.motion, row.motion + size_t{6} * x, size_t{6} * count);
  HWY_ALIGN uint16_t halves[kAxes][kChunk_px];
  for (size_t i = 0; i < kChunk_px; i += hn::Lanes(kAllHalves)) {
    hn::Vec<decltype(kAllHalves)> axes[kAxes];
    hn::LoadInterleaved3(kAllHalves, chunk.motion + kAxes * i, axes[0], axes[1], axes[2]);
    for (size_t axis = 0; axis < kAxes; ++axis) {
      hn::StoreU(axes[axis], kAllHalves, halves[axis] + i);
    }
  }
  const hn::Rebind<hwy::float16_t, Floats> vector_halves;
  for (size_t axis = 0; axis < kAxes; ++axis) {
    for (size_t i = 0; i < kChunk_px; i += hn::Lanes(kFloats)) {
      const auto* const from = reinterpret_cast<const hwy::float16_t*>(halves[axis]) + i;
      hn::StoreU(hn::PromoteTo(kFloats, hn::LoadU(vector_halves, from)), kFloats,
                 chunk.speed[axis] + i);
    }
  }
}

HWY_INLINE DoubleVec dot(const glm::dvec3& a, const DoubleVec* b) {
  const DoubleVec sum = hn::Add(hn::Mul(setDouble(a.x), b[0]), hn::Mul(setDouble(a.y), b[1]));
  return hn::Add(sum, hn::Mul(setDouble(a.z), b[2]));
}

// The least and the most of what is met.
struct Range {
  Range() : least(hn::Zero(kDoubles)), most(hn::Zero(kDoubles)) {}

  HWY_INLINE void meet(DoubleVec value) {
    least = hn::Min(least, value);
    most = hn::Max(most, value);
  }

  DoubleVec least, most;
};

// With X and Y in px from the principal point (Y down), w = 1/Z and m the way in the camera's
// space: the point (X / fx, -Y / fy, -1) / w goes by m. Times w, its distance from the camera
// becomes q = 1 - w m.z, so w' = w / q and X' = (X + fx w m.x) / q, Y' = (Y - fy w m.y) / q.
// Written as what is added to X and Y, nothing is added where m = 0.
HWY_INLINE void moveVector(const MotionRow& row, uint32_t x, size_t i, Chunk& chunk, Range& dx,
                           Range& dy) {
  const DoubleVec zero = hn::Zero(kDoubles);
  DoubleVec speed[kAxes];
  for (size_t axis = 0; axis < kAxes; ++axis) speed[axis] = loadDoubles(chunk.speed[axis] + i);
  const DoubleVec w = loadDoubles(row.inv_z + x + i);
  const auto is_fast =
      hn::Or(hn::Or(hn::Ne(speed[0], zero), hn::Ne(speed[1], zero)), hn::Ne(speed[2], zero));
  const auto moves = hn::And(is_fast, hn::Gt(w, zero));
  const DoubleVec way_x = dot(row.axes_s[0], speed);
  const DoubleVec way_y = dot(row.axes_s[1], speed);
  const DoubleVec way_z = dot(row.axes_s[2], speed);
  const DoubleVec right_px =
      hn::Sub(hn::Iota(kDoubles, double(x + i) + 0.5), setDouble(row.principal_x_px));
  const DoubleVec nearness = hn::Sub(setDouble(1), hn::Mul(w, way_z));
  const DoubleVec quotient = hn::Div(w, nearness);
  const auto stays = hn::And(hn::Gt(nearness, zero), hn::Le(quotient, setDouble(double{kInvZMax})));
  const DoubleVec scale = hn::IfThenElseZero(hn::And(stays, moves), quotient);
  const DoubleVec across =
      hn::Add(hn::Mul(setDouble(row.focal_px.x), way_x), hn::Mul(right_px, way_z));
  const DoubleVec down =
      hn::Sub(hn::Mul(setDouble(row.down_px), way_z), hn::Mul(setDouble(row.focal_px.y), way_y));
  const DoubleVec dx_px = hn::Mul(scale, across), dy_px = hn::Mul(scale, down);
  dx.meet(dx_px);
  dy.meet(dy_px);
  const DoubleVec moved = hn::IfThenElse(stays, scale, setDouble(double{abi::kNoSurface}));
  storeFloats(dx_px, chunk.dx_px + i);
  storeFloats(dy_px, chunk.dy_px + i);
  storeFloats(hn::IfThenElse(moves, moved, w), chunk.inv_z + i);
  storeBytes(moves, chunk.moves + i);
}

HWY_INLINE double leastOf(DoubleVec value) {
  return hn::GetLane(hn::MinOfLanes(kDoubles, value));
}
HWY_INLINE double mostOf(DoubleVec value) {
  return hn::GetLane(hn::MaxOfLanes(kDoubles, value));
}

WayRange MoveRow(const MotionRow& row, const MovedRow& moved) {
  Range dx, dy;
  Chunk chunk;
  for (uint32_t x = row.first; x < row.end; x += kChunk_px) {
    const uint32_t count = std::min(kChunk_px, row.end - x);
    if (count < kChunk_px) std::fill(chunk.motion, chunk.motion + kAxes * kChunk_px, uint16_t{0});
    loadSpeed(row, x, count, chunk);
    for (size_t i = 0; i < count; i += hn::Lanes(kDoubles)) {
      moveVector(row, x, i, chunk, dx, dy);
    }
    std::copy_n(chunk.dx_px, count, moved.dx_px + x);
    std::copy_n(chunk.dy_px, count, moved.dy_px + x);
    std::copy_n(chunk.inv_z, count, moved.inv_z + x);
    std::copy_n(chunk.moves, count, moved.moves + x);
  }
  return {.least_px = {leastOf(dx.least), leastOf(dy.least)},
          .most_px = {mostOf(dx.most), mostOf(dy.most)}};
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewloom {

HWY_EXPORT(MoveRow);

WayRange moveRow(const MotionRow& row, const MovedRow& moved) {
  return HWY_DYNAMIC_DISPATCH(MoveRow)(row, moved);
}

}  // namespace viewloom
#endif
