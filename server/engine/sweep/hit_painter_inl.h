// SPDX-License-Identifier: Apache-2.0
// Paints what rays hit on a row of a view, the nearest on top, for each kind of CPU anew.
#if defined(VIEWLOOM_SERVER_SWEEP_HIT_PAINTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWLOOM_SERVER_SWEEP_HIT_PAINTER_INL_H_
#undef VIEWLOOM_SERVER_SWEEP_HIT_PAINTER_INL_H_
#else
#define VIEWLOOM_SERVER_SWEEP_HIT_PAINTER_INL_H_
#endif

#include <bit>

#include "sweep/run_crossing_inl.h"
#include "sweep/sweep_fault.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// Calls paint(first px of a vector, its px as floats, which of them are in [from, to)).
template <class Paint>
HWY_INLINE void forVectors(int32_t from, int32_t to, Paint paint) {
  const int32_t lanes = int32_t(hn::Lanes(kFloats));
  const Vec first = set(float(from));
  const Vec last = set(float(to));
  for (int32_t begin = from & ~(lanes - 1); begin < to; begin += lanes) {
    const Vec p = hn::Iota(kFloats, float(begin));
    paint(begin, p, hn::And(hn::Ge(p, first), hn::Lt(p, last)));
  }
}

// The same for those of the vectors that are marked: of few, most runs cover none.
template <class Paint>
HWY_INLINE void forMarkedVectors(const uint64_t* marks, int32_t from, int32_t to, Paint paint) {
  const int32_t lanes = int32_t(hn::Lanes(kFloats));
  const int32_t first = from / lanes;
  const int32_t last = (to - 1) / lanes;
  for (int32_t word = first / 64; word <= last / 64; ++word) {
    uint64_t bits = marks[word];
    if (word == first / 64) bits &= ~uint64_t{0} << (first % 64);
    if (word == last / 64) bits &= ~uint64_t{0} >> (63 - last % 64);
    for (; bits != 0; bits &= bits - 1) {
      const int32_t begin = (word * 64 + std::countr_zero(bits)) * lanes;
      const Vec p = hn::Iota(kFloats, float(begin));
      paint(begin, p, hn::And(hn::Ge(p, set(float(from))), hn::Lt(p, set(float(to)))));
    }
  }
}

// Hits of a layer. Only beyond where they passed behind the layer before it can rays hit a deeper
// one, and not beyond where they met a far side.
class HitPainter {
 public:
  HitPainter(SweptRow& swept, uint32_t layer, SweepFault planted_fault)
      : swept_(swept), last_wins_(planted_fault == SweepFault::kLastWins) {
    if (layer > 0 && layer < swept.passed_layer_count) met_ = swept.met_inv_z[layer].data();
    if (layer == 0 || planted_fault == SweepFault::kPassedIgnored) return;
    passed_ = swept.passed_inv_z[layer - 1].data();
    marks_ = swept.passed_vectors[layer - 1].data();
  }

  // at(first px of a vector, its px as floats): their inv_z and texels.
  template <class At>
  HWY_INLINE void paint(int32_t from, int32_t to, At at) const {
    const auto paint_vector = [&](int32_t begin, Vec p, Mask inside) {
      const auto [inv_z, texel] = at(begin, p);
      paintVector(begin, inside, inv_z, texel);
    };
    if (passed_ == nullptr)
      forVectors(from, to, paint_vector);
    else
      forMarkedVectors(marks_, from, to, paint_vector);
  }

 private:
  HWY_INLINE void paintVector(int32_t begin, Mask inside, Vec inv_z, IntVec texel) const {
    float* const inv_z_row = swept_.inv_z.data() + begin;
    int32_t* const texel_row = swept_.texel.data() + begin;
    const Vec before = hn::Load(kFloats, inv_z_row);
    Mask is_nearer = last_wins_ ? inside : hn::And(inside, hn::Gt(inv_z, before));
    if (passed_ != nullptr) {
      is_nearer = hn::And(is_nearer, hn::Le(inv_z, hn::Load(kFloats, passed_ + begin)));
    }
    if (met_ != nullptr) {
      is_nearer = hn::And(is_nearer, hn::Gt(inv_z, hn::Load(kFloats, met_ + begin)));
    }
    hn::Store(hn::IfThenElse(is_nearer, inv_z, before), kFloats, inv_z_row);
    hn::Store(hn::IfThenElse(hn::RebindMask(kInts, is_nearer), texel, hn::Load(kInts, texel_row)),
              kInts, texel_row);
  }

  SweptRow& swept_;
  const float* passed_ = nullptr;
  const uint64_t* marks_ = nullptr;
  const float* met_ = nullptr;
  const bool last_wins_;
};

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard, once for each kind of CPU
