// SPDX-License-Identifier: Apache-2.0
// Rays of a block of px through a lens, and where they meet sheets, for each kind of CPU anew.
#if defined(VIEWLOOM_SERVER_LENS_LENS_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWLOOM_SERVER_LENS_LENS_RAYS_INL_H_
#undef VIEWLOOM_SERVER_LENS_LENS_RAYS_INL_H_
#else
#define VIEWLOOM_SERVER_LENS_LENS_RAYS_INL_H_
#endif

#include "lens/gather_kernels.h"
#include "sweep/vectors_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// A number for each px of the block.
template <typename T>
struct alignas(64) OfPx {
  T at[kBlockArea_px];
};
using IntOfPx = OfPx<int32_t>;

// Homogeneous px of the source.
struct Point3 {
  Vec x, y, z;
};

HWY_INLINE Vec loadPx(const OfBlock& of_px, size_t p) {
  return hn::Load(kFloats, of_px.data() + p);
}

HWY_INLINE Vec dot3(const glm::vec3& plane, const Point3& point) {
  return hn::MulAdd(set(plane.x), point.x,
                    hn::MulAdd(set(plane.y), point.y, hn::Mul(set(plane.z), point.z)));
}

HWY_INLINE Point3 moved(const Point3& from, Vec x, const glm::vec3& along_x, Vec y,
                        const glm::vec3& along_y) {
  return {hn::MulAdd(x, set(along_x.x), hn::MulAdd(y, set(along_y.x), from.x)),
          hn::MulAdd(x, set(along_x.y), hn::MulAdd(y, set(along_y.y), from.y)),
          hn::MulAdd(x, set(along_x.z), hn::MulAdd(y, set(along_y.z), from.z))};
}

// A vector of rays of the block.
struct LensRay {
  Point3 eye, direction;
};

// The rays of a point of the lens, of all px. From the eye on, homogeneous px of the source for a
// metre along the view's axis.
struct LensRays {
  OfBlock eye_x, eye_y, eye_z, x, y, z;

  HWY_INLINE LensRay at(size_t p) const {
    return {{loadPx(eye_x, p), loadPx(eye_y, p), loadPx(eye_z, p)},
            {loadPx(x, p), loadPx(y, p), loadPx(z, p)}};
  }
};

// The middle rays of the block's px.
struct Directions {
  OfBlock x, y, z;

  explicit Directions(const GatheredRays& rays) {
    const abi::ViewParams& view = rays.view;
    for (size_t p = 0; p < kBlockArea_px; ++p) {
      const float px = rays.first_x_px + float(p % abi::kMetBlockSide_px) + 0.5F;
      const float py = rays.first_y_px + float(p / abi::kMetBlockSide_px) + 0.5F;
      const glm::vec3 direction = view.direction + px * view.direction_dx + py * view.direction_dy;
      x[p] = direction.x;
      y[p] = direction.y;
      z[p] = direction.z;
    }
  }
};

// The same as makeLensRay in shaders/lib/lens/lens_rays.glsl.
HWY_INLINE LensRay lensRay(const abi::ViewParams& view, const Directions& directions,
                           const LensPoint& point, size_t p) {
  const Vec moved_x = hn::Mul(set(view.lens_px_m.x), hn::Load(kFloats, point.x.data() + p));
  const Vec moved_y = hn::Mul(set(-view.lens_px_m.y), hn::Load(kFloats, point.y.data() + p));
  const Vec step_x = hn::NegMulAdd(set(view.lens_inv_focus), moved_x, set(point.beside_x_px));
  const Vec step_y = hn::NegMulAdd(set(view.lens_inv_focus), moved_y, set(point.beside_y_px));
  const Point3 eye{set(view.eye.x), set(view.eye.y), set(view.eye.z)};
  const Point3 direction{loadPx(directions.x, p), loadPx(directions.y, p), loadPx(directions.z, p)};
  return {moved(eye, moved_x, view.direction_dx, moved_y, view.direction_dy),
          moved(direction, step_x, view.direction_dx, step_y, view.direction_dy)};
}

HWY_INLINE void raysOf(const abi::ViewParams& view, const Directions& directions,
                       const LensPoint& point, LensRays& rays) {
  for (size_t p = 0; p < kBlockArea_px; p += hn::Lanes(kFloats)) {
    const LensRay ray = lensRay(view, directions, point, p);
    hn::Store(ray.eye.x, kFloats, rays.eye_x.data() + p);
    hn::Store(ray.eye.y, kFloats, rays.eye_y.data() + p);
    hn::Store(ray.eye.z, kFloats, rays.eye_z.data() + p);
    hn::Store(ray.direction.x, kFloats, rays.x.data() + p);
    hn::Store(ray.direction.y, kFloats, rays.y.data() + p);
    hn::Store(ray.direction.z, kFloats, rays.z.data() + p);
  }
}

// The image as vectors compare with it.
struct Image {
  explicit Image(SizePx size_px)
      : width(set(float(size_px.width))),
        height(set(float(size_px.height))),
        last_column(set(float(size_px.width - 1))),
        last_row(set(float(size_px.height - 1))) {}

  const Vec width, height, last_column, last_row;
};

// A coordinate of a place: which px of the image that is in, or the nearest.
struct Cell {
  Vec first;  // the px's own first place
  IntVec index;
};

// Cell at a place along an axis of the image. It is inside the image wherever the place is.
HWY_INLINE Cell cellOf(Vec place, Vec last) {
  const Vec first = hn::Min(hn::Floor(place), last);
  // Above 2^23 the steps of floats are 1.
  const WordVec bits = hn::BitCast(kWords, hn::Add(first, set(0x1p23F)));
  return {first, hn::BitCast(kInts, hn::And(bits, hn::Set(kWords, 0x7fffff)))};
}

// 0 also in place of what is no number.
HWY_INLINE Vec atLeastZero(Vec value) {
  return hn::IfThenElseZero(hn::Gt(value, hn::Zero(kFloats)), value);
}

// Where a ray meets a sheet.
struct Meeting {
  Vec x, y;        // the nearest place of the image
  Mask is_met;     // from the front
  Mask is_inside;  // the image, and met
  Cell column, row;
};

HWY_INLINE IntVec indexOf(const Meeting& at, uint32_t pitch) {
  return hn::Add(hn::Mul(at.row.index, hn::Set(kInts, int32_t(pitch))), at.column.index);
}

// The same as `meets` in shaders/lib/lens/lens_rays.glsl.
HWY_INLINE Meeting meet(const glm::vec3& plane, const LensRay& ray, const Image& image) {
  constexpr float kTowardsMin = 1e-20F;
  const Vec one = set(1);
  const Vec in_front = hn::Sub(one, dot3(plane, ray.eye));
  const Vec towards = hn::Max(dot3(plane, ray.direction), set(kTowardsMin));
  const auto along = [&](Vec eye, Vec direction) {
    return hn::MulAdd(towards, eye, hn::Mul(in_front, direction));
  };
  const Vec z = along(ray.eye.z, ray.direction.z);
  const Vec zero = hn::Zero(kFloats);
  const Mask is_met = hn::And(hn::Gt(in_front, zero), hn::Gt(z, zero));
  const Vec scale = hn::Div(one, z);
  const Vec x = hn::Mul(along(ray.eye.x, ray.direction.x), scale);
  const Vec y = hn::Mul(along(ray.eye.y, ray.direction.y), scale);
  Meeting at;
  at.x = hn::Min(atLeastZero(x), image.width);
  at.y = hn::Min(atLeastZero(y), image.height);
  at.is_met = is_met;
  at.is_inside = hn::And(is_met, hn::And(hn::Eq(x, at.x), hn::Eq(y, at.y)));
  at.column = cellOf(at.x, image.last_column);
  at.row = cellOf(at.y, image.last_row);
  return at;
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard, once for each kind of CPU
