// SPDX-License-Identifier: Apache-2.0
#include "display/lens.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>

#include "base/str_cat.h"
#include "display/atlas_layout.h"
#include "display/depth_budget.h"

namespace viewloom {
namespace {

// The positive root of x^3 = x + 1: R2 steps by its negative powers.
constexpr double kRoot = 1.32471795724474602596;

glm::dvec2 quasiRandom(uint32_t index) {
  return glm::fract(0.5 + double(index) * glm::dvec2(1 / kRoot, 1 / (kRoot * kRoot)));
}

// Along a curve of Z's, from the right: 2x2 px of the pattern follow each other, and four of those.
uint32_t placeOnCurve(uint32_t x_px, uint32_t y_px) {
  uint32_t place = 0;
  for (uint32_t bit = 1, weight = 1; bit < kLensPatternSide_px; bit *= 2, weight *= 4) {
    place += weight * ((x_px & bit) == 0 ? 1 : 0) + 2 * weight * ((y_px & bit) != 0 ? 1 : 0);
  }
  return place;
}

// The first two axes of Sobol's sequence ("On the distribution of points in a cube", 1967): of 4,
// 16, 64 that follow each other from a multiple of as many on, there is one in each cell of a grid
// of 2x2, 4x4, 8x8. No shift is the difference of two points of the R2 sequence, so that no px has
// the points of another.
glm::dvec2 shiftAt(uint32_t place) {
  uint32_t x = 0x80000000;  // halves of halves
  uint32_t y = 0x80000000;  // rows of Pascal's triangle, modulo 2
  glm::uvec2 bits(0);
  for (uint32_t rest = place; rest > 0; rest /= 2, x >>= 1, y ^= y >> 1) {
    if (rest % 2 != 0) bits ^= glm::uvec2(x, y);
  }
  return glm::dvec2(bits) / 0x1p32;
}

// Shirley and Chiu, "A Low Distortion Map Between Disk and Square" (1997): squares around the
// middle become rings of the same share of the area.
struct Polar {
  double radius = 0;
  double angle_rad = 0;
};
Polar concentric(glm::dvec2 square) {
  const glm::dvec2 at = 2.0 * square - 1.0;
  if (at.x == 0 && at.y == 0) return {};
  constexpr double kQuarter_rad = std::numbers::pi / 4;
  if (std::abs(at.x) > std::abs(at.y)) return {at.x, kQuarter_rad * at.y / at.x};
  return {at.y, kQuarter_rad * (2 - at.x / at.y)};
}

// A blade is a straight side: rings become polygons, and the area of the triangle between a side
// and the middle is covered as evenly as that of the sector was.
glm::dvec2 throughBlades(Polar at, uint32_t blades, double rotation_rad) {
  if (at.radius < 0) at = {-at.radius, at.angle_rad + std::numbers::pi};
  if (blades == 0) return at.radius * glm::dvec2(std::cos(at.angle_rad), std::sin(at.angle_rad));
  const double turn = at.angle_rad / (2 * std::numbers::pi);
  const double place = (turn - std::floor(turn)) * blades;
  const double blade = std::floor(place);
  const auto corner = [&](double index) {
    const double angle_rad = rotation_rad + 2 * std::numbers::pi * index / blades;
    return glm::dvec2(std::cos(angle_rad), std::sin(angle_rad));
  };
  return at.radius * glm::mix(corner(blade), corner(blade + 1), place - blade);
}

// With the blur taken off, no surface moves by more than the ghosting limit from view to view: a
// lens as wide as the way between two eyes blurs a surface by as much as that would move if the
// plane in focus were the focal plane. No lens is wider than that: it does not help what ghosts in
// focus.
double automaticRadius_m(const AtlasLayout& layout, const StreamDefaults& defaults,
                         double focus_m) {
  const double px_per_inv_z = disparityPerInvZ(layout);
  double share = 0;  // of the way between two eyes
  for (const double inv_z : {defaults.inv_z_near, defaults.inv_z_far}) {
    const double moved_px = px_per_inv_z * std::abs(inv_z - 1 / layout.eye_focus_m);
    const double blurred_px = px_per_inv_z * std::abs(inv_z - 1 / focus_m);
    const double ghost_px = moved_px - kGhostingLimit_px;
    if (ghost_px > 0) share = std::max(share, ghost_px < blurred_px ? ghost_px / blurred_px : 1.0);
  }
  return share * std::max(layout.view_pitch_m.x, layout.view_pitch_m.y) / 2;
}

}  // namespace

absl::StatusOr<std::optional<LensRays>> lensRays(const LensSpec& lens, const AtlasLayout& layout,
                                                 const StreamDefaults& defaults) {
  const double focus_m = lens.focus_distance_m.value_or(layout.eye_focus_m);
  if (focus_m == kNoFocus_m) {
    return fieldError(
        absl::StatusCode::kFailedPrecondition, "effects.lens.focus_distance_m",
        "the distance in focus is not given, and this display has no focal plane to take "
        "it from; give the distance in metres");
  }
  double radius_m = lens.aperture_radius_m;
  if (lens.has_automatic_aperture) {
    if (!(disparityPerInvZ(layout) > 0) || layout.eye_focus_m == kNoFocus_m) {
      return fieldError(absl::StatusCode::kFailedPrecondition, "effects.lens.automatic_aperture",
                        "the automatic aperture needs neighbouring views on one focal plane, and "
                        "this display has none; give aperture_radius_m instead");
    }
    radius_m = automaticRadius_m(layout, defaults, focus_m);
    if (radius_m == 0) return std::nullopt;
  }
  return LensRays{.radius_m = radius_m,
                  .focus_m = focus_m,
                  .blades = lens.blades,
                  .rotation_rad = lens.rotation_rad,
                  .walked_count = lens.walked_count,
                  .gathered_count = *lens.gathered_count,
                  .is_exact = lens.is_exact};
}

std::vector<glm::vec2> lensPoints(const LensRays& lens) {
  std::vector<glm::vec2> points;
  points.reserve(size_t{lens.pointCount()} * kLensPatternArea_px);
  for (uint32_t point = 0; point < lens.pointCount(); ++point) {
    for (uint32_t y_px = 0; y_px < kLensPatternSide_px; ++y_px) {
      for (uint32_t x_px = 0; x_px < kLensPatternSide_px; ++x_px) {
        const glm::dvec2 moved = quasiRandom(point) + shiftAt(placeOnCurve(x_px, y_px));
        const Polar at = concentric(glm::fract(moved));
        points.emplace_back(throughBlades(at, lens.blades, lens.rotation_rad));
      }
    }
  }
  return points;
}

}  // namespace viewloom
