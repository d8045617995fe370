// SPDX-License-Identifier: Apache-2.0
// The rays of a row of a view in vectors, for each kind of CPU anew.
#if defined(VIEWLOOM_SERVER_SWEEP_ROW_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWLOOM_SERVER_SWEEP_ROW_RAYS_INL_H_
#undef VIEWLOOM_SERVER_SWEEP_ROW_RAYS_INL_H_
#else
#define VIEWLOOM_SERVER_SWEEP_ROW_RAYS_INL_H_
#endif

#include "sweep/swept_row.h"
#include "sweep/vectors_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// Values that kernels need of a SweepView, computed once for the whole row.
class RowRays {
 public:
  // Over `run_count` runs. Keeps in `swept`, which must outlive it, where each of few rays is.
  RowRays(const SweepView& view, uint32_t width_px, uint32_t run_count, SweptRow& swept)
      : width_px_(width_px),
        travel_(view.eye_px_m > 0 ? Travel::kLeft : Travel::kRight),
        leave_source_(view.eye_px_m != 0),
        are_few_(width_px < run_count || !view.hasOneEye()),
        eye_moves_(view.eye_step_px_m != 0),
        jumps_(view.jumps()),
        start_px_(set(view.start_px)),
        step_px_(set(view.step_px)),
        per_step_(set(1 / view.step_px)),
        eye_px_m_(set(view.eye_px_m)),
        per_eye_(set(1 / view.eye_px_m)),
        eye_step_px_m_(set(view.eye_step_px_m)),
        jump_px_(set(view.jump_px)),
        last_before_jump_(set(view.jump_px - 1)),
        jump_start_(set(view.jump_start_px / view.step_px)),
        jump_eye_m_(set(view.jump_eye_px_m / view.step_px)),
        starts_px_(swept.start_px.data()),
        eyes_px_m_(swept.eye_px_m.data()),
        per_eyes_(swept.per_eye_m_px.data()) {
    if (are_few_) placeEach(view);
  }

  uint32_t widthPx() const { return width_px_; }
  Travel travel() const { return travel_; }
  // Else they end where they start, as those of the source's own place do.
  bool leaveSource() const { return leave_source_; }
  // Fewer than runs, or of several eyes: each is placed for itself. Else all have one eye.
  bool areFew() const { return are_few_; }

  // Start at pixel 0, and the step between pixels.
  Vec startPx() const { return start_px_; }
  Vec stepPx() const { return step_px_; }
  // Starts of few rays: the pixels of a vector from `first` on.
  HWY_INLINE Vec startsFrom(int32_t first) const { return hn::Load(kFloats, starts_px_ + first); }
  // Eyes of all rays.
  HWY_INLINE Vec eyesFrom(int32_t first) const {
    return are_few_ ? hn::Load(kFloats, eyes_px_m_ + first) : eye_px_m_;
  }
  HWY_INLINE Vec perEyesFrom(int32_t first) const {
    return are_few_ ? hn::Load(kFloats, per_eyes_ + first) : per_eye_;
  }

  // Where the ray of a px is at inv_z 0 if that of px 0 is at x at inv_z w.
  HWY_INLINE Vec startOf(Vec x, Vec inv_z) const { return hn::NegMulAdd(eye_px_m_, inv_z, x); }

  // The first px whose place at inv_z is not below x, within the row.
  HWY_INLINE IntVec columnOf(Vec x, Vec inv_z) const {
    const Vec beside = hn::Sub(startOf(x, inv_z), start_px_);
    Vec p = eye_moves_ ? hn::Div(beside, hn::MulAdd(eye_step_px_m_, inv_z, step_px_))
                       : hn::Mul(beside, per_step_);
    if (jumps_) {
      const Vec back = hn::MulAdd(jump_eye_m_, inv_z, jump_start_);
      const Vec beyond = hn::Max(hn::Sub(p, back), jump_px_);
      p = hn::IfThenElse(hn::Le(p, last_before_jump_), p, beyond);
    }
    const Vec width = set(float(width_px_));
    return hn::ConvertTo(kInts, hn::Min(hn::Max(hn::Ceil(p), set(0)), width));
  }

 private:
  // Without a jump, all are so far, by nothing, beyond it.
  void placeEach(const SweepView& view) {
    const Vec jump_start_px = set(view.jump_start_px);
    const Vec jump_eye_px_m = set(view.jump_eye_px_m);
    for (size_t first = 0; first < width_px_; first += hn::Lanes(kFloats)) {
      const Vec p = hn::Iota(kFloats, float(first));
      const Mask is_beyond = hn::Ge(p, jump_px_);
      const Vec starts =
          hn::Add(hn::MulAdd(step_px_, p, start_px_), hn::IfThenElseZero(is_beyond, jump_start_px));
      const Vec eyes = hn::Add(hn::MulAdd(eye_step_px_m_, p, eye_px_m_),
                               hn::IfThenElseZero(is_beyond, jump_eye_px_m));
      hn::Store(starts, kFloats, starts_px_ + first);
      hn::Store(eyes, kFloats, eyes_px_m_ + first);
      hn::Store(hn::Div(set(1), eyes), kFloats, per_eyes_ + first);
    }
  }

  uint32_t width_px_;
  Travel travel_;
  bool leave_source_, are_few_, eye_moves_, jumps_;
  Vec start_px_, step_px_, per_step_;
  Vec eye_px_m_, per_eye_, eye_step_px_m_;
  Vec jump_px_, last_before_jump_;
  Vec jump_start_, jump_eye_m_;  // in px of the view
  float *starts_px_, *eyes_px_m_, *per_eyes_;
};

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard, once for each kind of CPU
