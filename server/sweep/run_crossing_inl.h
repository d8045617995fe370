// SPDX-License-Identifier: Apache-2.0
// Where the rays of a row of a view cross runs of the source, for each kind of CPU anew.
#if defined(VIEWLOOM_SERVER_SWEEP_RUN_CROSSING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWLOOM_SERVER_SWEEP_RUN_CROSSING_INL_H_
#undef VIEWLOOM_SERVER_SWEEP_RUN_CROSSING_INL_H_
#else
#define VIEWLOOM_SERVER_SWEEP_RUN_CROSSING_INL_H_
#endif

#include "sweep/swept_row.h"
#include "sweep/vectors_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// What rays meet.
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

// Of each px p.
HWY_INLINE Vec startsAt(const SweepView& view, Vec p) {
  const Vec starts = hn::MulAdd(set(view.step_px), p, set(view.start_px));
  if (!view.jumps()) return starts;
  return hn::Add(starts, hn::IfThenElseZero(hn::Ge(p, set(view.jump_px)), set(view.jump_start_px)));
}
HWY_INLINE Vec eyesAt(const SweepView& view, Vec p) {
  const Vec eyes = hn::MulAdd(set(view.eye_step_px_m), p, set(view.eye_px_m));
  if (!view.jumps()) return eyes;
  return hn::Add(eyes, hn::IfThenElseZero(hn::Ge(p, set(view.jump_px)), set(view.jump_eye_px_m)));
}

// Where the ray of a px is at inv_z 0 if that of px 0 is at x at inv_z w.
HWY_INLINE Vec startOf(const SweepView& view, Vec x, Vec inv_z) {
  return hn::NegMulAdd(set(view.eye_px_m), inv_z, x);
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

HWY_INLINE RunSlopes slopesOf(const RunLanes& run, const SweepView& view) {
  const Vec u = startOf(view, run.begin, run.begin_w);
  const Vec u_end = startOf(view, run.end, run.end_w);
  // Along u, of what faces the rays.
  const Vec per_u = hn::Div(set(1), hn::Sub(u_end, u));
  const Vec x_per_u = hn::Mul(hn::Sub(run.end, run.begin), per_u);
  const Vec w_per_u = hn::Mul(hn::Sub(run.end_w, run.begin_w), per_u);
  const Vec first = hn::Sub(set(view.start_px), u);
  return {hn::MulAdd(w_per_u, first, run.begin_w), hn::Mul(w_per_u, set(view.step_px)),
          hn::Mul(hn::MulAdd(x_per_u, first, run.begin), set(kSubtexelSteps)),
          hn::Mul(x_per_u, set(kSubtexelSteps * view.step_px))};
}

// Of runs that rays graze, little is left of a difference: no place is beside the run.
class LineCrossing {
 public:
  LineCrossing(const RunLanes& run, const RunSlopes& slopes)
      : slopes_(slopes),
        low_(hn::Min(run.begin_w, run.end_w)),
        high_(hn::Max(run.begin_w, run.end_w)),
        first_place_(hn::Mul(run.begin, set(kSubtexelSteps))),
        last_place_(hn::Mul(run.end, set(kSubtexelSteps))),
        offset_(run.offset) {}
  LineCrossing(const RunLanes& run, const SweepView& view)
      : LineCrossing(run, slopesOf(run, view)) {}

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

// The same ray by ray, whose eyes may be in several places.
class RayCrossing {
 public:
  RayCrossing(const RunLanes& run, const SweepView& view)
      : view_(view),
        begin_(run.begin),
        begin_w_(run.begin_w),
        across_(hn::Sub(run.end, run.begin)),
        up_(hn::Sub(run.end_w, run.begin_w)),
        offset_(run.offset) {}

  HWY_INLINE Place at(Vec p) const {
    const Vec eye = eyesAt(view_, p);
    const Vec beside = hn::Sub(hn::MulAdd(eye, begin_w_, startsAt(view_, p)), begin_);
    const Vec share = hn::Div(beside, hn::NegMulAdd(eye, up_, across_));
    const Vec along = hn::Min(hn::Max(share, set(0)), set(1));
    const Vec place = hn::Mul(hn::MulAdd(across_, along, begin_), set(kSubtexelSteps));
    return {hn::MulAdd(up_, along, begin_w_), texelAt(place, offset_)};
  }

 private:
  const SweepView& view_;
  Vec begin_, begin_w_, across_, up_;
  IntVec offset_;
};

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard, once for each kind of CPU
