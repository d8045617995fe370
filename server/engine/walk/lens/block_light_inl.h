// SPDX-License-Identifier: Apache-2.0
// The light of texels, and sums of it by px, for each kind of CPU anew.
#if defined(VIEWLOOM_SERVER_LENS_BLOCK_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWLOOM_SERVER_LENS_BLOCK_LIGHT_INL_H_
#undef VIEWLOOM_SERVER_LENS_BLOCK_LIGHT_INL_H_
#else
#define VIEWLOOM_SERVER_LENS_BLOCK_LIGHT_INL_H_
#endif

#include "lens/lens_rays_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

struct Light {
  Vec red, green, blue;
};

// The same as linearFromSrgb in shaders/lib/light/srgb.glsl, of codes 0..255.
HWY_INLINE Vec lightOfCode(Vec code) {
  const Vec srgb = hn::Mul(code, set(1.0F / 255));
  Vec curve = hn::MulAdd(set(-0.1167994F), srgb, set(0.5265083F));
  curve = hn::MulAdd(curve, srgb, set(0.5603838F));
  curve = hn::MulAdd(curve, srgb, set(0.02840018F));
  curve = hn::MulAdd(curve, srgb, set(0.001046527F));
  return hn::IfThenElse(hn::Le(srgb, set(0.04045F)), hn::Mul(srgb, set(1.0F / 12.92F)), curve);
}

HWY_INLINE Light lightOf(WordVec rgba) {
  const auto channel = [&](WordVec shifted) {
    const WordVec code = hn::And(shifted, hn::Set(kWords, 255));
    return lightOfCode(hn::ConvertTo(kFloats, hn::BitCast(kInts, code)));
  };
  return {channel(rgba), channel(hn::ShiftRight<8>(rgba)), channel(hn::ShiftRight<16>(rgba))};
}

// The same as codesFromLinear in shaders/lib/light/srgb.glsl.
HWY_INLINE Vec codeOfLight(Vec light) {
  const Vec clipped = hn::Min(hn::Max(light, hn::Zero(kFloats)), set(1));
  const Vec root = hn::Sqrt(clipped);
  Vec curve = hn::MulAdd(set(131.81537F), root, set(-413.74127F));
  curve = hn::MulAdd(curve, root, set(517.73502F));
  curve = hn::MulAdd(curve, root, set(-357.54774F));
  curve = hn::MulAdd(curve, root, set(387.04785F));
  curve = hn::MulAdd(curve, root, set(-10.2261349F));
  return hn::IfThenElse(hn::Le(clipped, set(0.0031308F)), hn::Mul(clipped, set(12.92F * 255)),
                        curve);
}

HWY_INLINE void addTo(OfBlock& sums, size_t p, Vec value) {
  hn::Store(hn::Add(loadPx(sums, p), value), kFloats, sums.data() + p);
}

HWY_INLINE void add(BlockLight& sums, size_t p, const Light& light, Vec count) {
  addTo(sums.red, p, light.red);
  addTo(sums.green, p, light.green);
  addTo(sums.blue, p, light.blue);
  addTo(sums.count, p, count);
}

void MeanOf(const BlockLight& light, BlockCodes& codes) {
  for (size_t p = 0; p < kBlockArea_px; p += hn::Lanes(kFloats)) {
    const Vec share = hn::Div(set(1), hn::Max(loadPx(light.count, p), set(1)));
    const auto code = [&](const OfBlock& sums, OfBlock& to) {
      hn::Store(codeOfLight(hn::Mul(loadPx(sums, p), share)), kFloats, to.data() + p);
    };
    code(light.red, codes.red);
    code(light.green, codes.green);
    code(light.blue, codes.blue);
  }
}

HWY_INLINE Light lightOfThose(Mask those, WordVec texel) {
  const Light light = lightOf(texel);
  return {hn::IfThenElseZero(those, light.red), hn::IfThenElseZero(those, light.green),
          hn::IfThenElseZero(those, light.blue)};
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard, once for each kind of CPU
