// SPDX-License-Identifier: Apache-2.0
// Where the rays of a row of a view cross runs of the source, for each kind of CPU anew.
#if defined(VIEWLOOM_SERVER_SWEEP_RUN_CROSSING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWLOOM_SERVER_SWEEP_RUN_CROSSING_INL_H_
#undef VIEWLOOM_SERVER_SWEEP_RUN_CROSSING_INL_H_
#else
#define VIEWLOOM_SERVER_SWEEP_RUN_CROSSING_INL_H_
#endif

#include "sweep/row_rays_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// Hit of a ray.
struct Place {
  Vec inv_z;
  IntVec texel;
};

// A run in each lane.
struct RunLanes {
  Vec begin, end;
  Vec begin_w, end_w;
  IntVec offset;
};

// Those from k on.
HWY_INLINE RunLanes runsFrom(const Runs& runs, size_t k) {
  return {hn::LoadU(kFloats, runs.begin_px.data() + k), hn::LoadU(kFloats, runs.end_px.data() + k),
          hn::LoadU(kFloats, runs.begin_inv_z.data() + k),
          hn::LoadU(kFloats, runs.end_inv_z.data() + k),
          hn::LoadU(kInts, runs.texel_offset.data() + k)};
}

// Run k in all.
HWY_INLINE RunLanes runEverywhere(const Runs& runs, size_t k) {
  return {set(runs.begin_px[k]), set(runs.end_px[k]), set(runs.begin_inv_z[k]),
          set(runs.end_inv_z[k]), hn::Set(kInts, runs.texel_offset[k])};
}

// The texel at a place, 1/256 px.
HWY_INLINE IntVec texelAt(Vec place, IntVec offset) {
  // Above 1.5 2^23 the low bits of floats are integers, of either sign.
  constexpr float kRounder = 0x1.8p23F;
  const IntVec unbiased = hn::Sub(offset, hn::BitCast(kInts, set(kRounder)));
  return hn::Add(hn::BitCast(kInts, hn::Add(place, set(kRounder))), unbiased);
}

// Runs over the px of one eye: at + step p.
struct RunSlopes {
  Vec inv_z_at, inv_z_step;
  Vec texel_at, texel_step;
};

HWY_INLINE RunSlopes slopesOf(const RunLanes& run, const RowRays& rays) {
  const Vec u = rays.startOf(run.begin, run.begin_w);
  const Vec u_end = rays.startOf(run.end, run.end_w);
  // Along u, of what faces the rays.
  const Vec per_u = hn::Div(set(1), hn::Sub(u_end, u));
  const Vec x_per_u = hn::Mul(hn::Sub(run.end, run.begin), per_u);
  const Vec w_per_u = hn::Mul(hn::Sub(run.end_w, run.begin_w), per_u);
  const Vec first = hn::Sub(rays.startPx(), u);
  return {hn::MulAdd(w_per_u, first, run.begin_w), hn::Mul(w_per_u, rays.stepPx()),
          hn::Mul(hn::MulAdd(x_per_u, first, run.begin), set(kSubtexelSteps)),
          hn::Mul(x_per_u, hn::Mul(set(kSubtexelSteps), rays.stepPx()))};
}

// Rays that graze a run leave little of a difference: no place lies beside the run.
class LineCrossing {
 public:
  LineCrossing(const RunLanes& run, const RunSlopes& slopes)
      : slopes_(slopes),
        low_(hn::Min(run.begin_w, run.end_w)),
        high_(hn::Max(run.begin_w, run.end_w)),
        first_place_(hn::Mul(run.begin, set(kSubtexelSteps))),
        last_place_(hn::Mul(run.end, set(kSubtexelSteps))),
        offset_(run.offset) {}

  HWY_INLINE Place at(Vec p) const {
    const Vec inv_z = hn::MulAdd(slopes_.inv_z_step, p, slopes_.inv_z_at);
    const Vec place = hn::MulAdd(slopes_.texel_step, p, slopes_.texel_at);
    return {hn::Min(hn::Max(inv_z, low_), high_),
            texelAt(hn::Min(hn::Max(place, first_place_), last_place_), offset_)};
  }

 private:
  RunSlopes slopes_;
  Vec low_, high_, first_place_, last_place_;
  IntVec offset_;
};

// The same of few rays, whose eyes may be in several places: nothing is worked out for a run alone.
class RayCrossing {
 public:
  RayCrossing(const RunLanes& run, const RowRays& rays)
      : rays_(rays),
        begin_(run.begin),
        begin_w_(run.begin_w),
        across_(hn::Sub(run.end, run.begin)),
        up_(hn::Sub(run.end_w, run.begin_w)),
        offset_(run.offset) {}

  // At the px of a vector from `first` on.
  HWY_INLINE Place from(int32_t first) const {
    const Vec eye = rays_.eyesFrom(first);
    const Vec beside = hn::Sub(hn::MulAdd(eye, begin_w_, rays_.startsFrom(first)), begin_);
    const Vec share = hn::Div(beside, hn::NegMulAdd(eye, up_, across_));
    const Vec along = hn::Min(hn::Max(share, set(0)), set(1));
    const Vec place = hn::Mul(hn::MulAdd(across_, along, begin_), set(kSubtexelSteps));
    return {hn::MulAdd(up_, along, begin_w_), texelAt(place, offset_)};
  }

 private:
  const RowRays& rays_;
  Vec begin_, begin_w_, across_, up_;
  IntVec offset_;
};

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard, once for each kind of CPU
