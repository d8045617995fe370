// SPDX-License-Identifier: Apache-2.0
#include "synthetic/portrait_textures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "synthetic/edges.h"

namespace viewloom::synthetic {
namespace {

using glm::vec2;
using glm::vec3;

constexpr vec3 kWood{0.16F, 0.06F, 0.03F};
constexpr vec3 kInk{0.95F, 0.80F, 0.42F};

constexpr int kLetterColumns = 5;
constexpr int kLetterRows = 7;
constexpr int kLetterStep = 6;  // columns from a letter to the next

// Rows from the top; '#' is inked.
using Letter = std::array<std::string_view, kLetterRows>;
constexpr Letter kV{"#...#", "#...#", "#...#", "#...#", ".#.#.", ".#.#.", "..#.."};
constexpr Letter kI{".###.", "..#..", "..#..", "..#..", "..#..", "..#..", ".###."};
constexpr Letter kE{"#####", "#....", "#....", "####.", "#....", "#....", "#####"};
constexpr Letter kW{"#...#", "#...#", "#...#", "#.#.#", "#.#.#", "##.##", "#...#"};
constexpr Letter kL{"#....", "#....", "#....", "#....", "#....", "#....", "#####"};
constexpr Letter kO{".###.", "#...#", "#...#", "#...#", "#...#", "#...#", ".###."};
constexpr Letter kM{"#...#", "##.##", "#.#.#", "#.#.#", "#...#", "#...#", "#...#"};
constexpr std::array<const Letter*, 8> kName{&kV, &kI, &kE, &kW, &kL, &kO, &kO, &kM};
constexpr int kNameColumns = kLetterStep * static_cast<int>(kName.size()) - 1;

bool isInked(int column, int row) {
  if (column < 0 || column >= kNameColumns || row < 0 || row >= kLetterRows) return false;
  const int in_letter = column % kLetterStep;
  if (in_letter >= kLetterColumns) return false;
  return (*kName[static_cast<size_t>(column / kLetterStep)])[static_cast<size_t>(row)]
                                                            [static_cast<size_t>(in_letter)] == '#';
}

// Share of a square of half width `edge` around `at` that ink covers; in cells, y down. A square
// wider than the name is taken to be that wide.
float inkShare(vec2 at, float edge) {
  const float half = std::clamp(edge, 1e-3F, 8.0F);
  const vec2 low = at - half;
  const vec2 high = at + half;
  const auto overlap = [](float low_edge, float high_edge, int cell) {
    const auto begin = static_cast<float>(cell);
    return std::max(0.0F, std::min(high_edge, begin + 1.0F) - std::max(low_edge, begin));
  };
  float area = 0;
  for (int row = static_cast<int>(std::floor(low.y)); static_cast<float>(row) < high.y; ++row) {
    for (int column = static_cast<int>(std::floor(low.x)); static_cast<float>(column) < high.x;
         ++column) {
      if (isInked(column, row)) {
        area += overlap(low.x, high.x, column) * overlap(low.y, high.y, row);
      }
    }
  }
  return area / (4.0F * half * half);
}

// Upright lines in groups from wide to narrow, from x = 0 to the right.
float lineShare(float x_m, float edge_m) {
  constexpr std::array<float, 4> kWidths_m{0.008F, 0.004F, 0.002F, 0.001F};
  constexpr float kGroup_m = 0.036F;
  if (x_m < 0 || x_m >= kGroup_m * kWidths_m.size()) return 0;
  const float width_m = kWidths_m[static_cast<size_t>(x_m / kGroup_m)];
  const float in_group_m = std::fmod(x_m, kGroup_m);
  if (in_group_m >= kGroup_m - width_m) return 0;
  const float edge = edge_m / width_m;
  // Lines that are finer than a pixel are grey.
  return edge >= 1.0F ? 0.5F : squareWave(in_group_m / width_m, std::min(edge, 0.5F));
}

// Soft banks of cloud that come round after a loop. u_m runs along the walls.
float cloudShare(float u_m, float y_m, float phase_rad) {
  const float bank = std::sin(3.1F * u_m + phase_rad + 1.7F * y_m) +
                     0.6F * std::sin(6.7F * u_m - phase_rad + 4.0F * y_m + 1.0F) +
                     0.4F * std::sin(13.0F * u_m + 2.0F * phase_rad - 9.0F * y_m);
  const float height = std::sin(7.5F * y_m + 0.8F * std::sin(2.3F * u_m + 0.6F));
  return std::clamp(0.34F * bank + 0.40F * height - 0.20F, 0.0F, 0.70F);
}

}  // namespace

PaintedRidge paintedRidge(const Scene& scene, const glm::dvec3& point_m) {
  const double from_corner_m = scene.backdrop->half_width_m - std::abs(point_m.x);
  for (const Ridge& ridge : scene.ridges) {
    const double along_m = point_m.z - ridge.z_m;
    if (from_corner_m > 1e-6 || along_m < 0) continue;
    const double x_m = point_m.x + std::copysign(along_m, point_m.x);
    if (point_m.y <= ridge.crestAt(x_m)) return {&ridge, {x_m, point_m.y}};
  }
  return {};
}

vec3 paintedSky(const Scene& scene, const glm::dvec3& point_m) {
  constexpr vec3 kLow{0.98F, 0.56F, 0.25F};
  constexpr vec3 kMiddle{0.48F, 0.56F, 0.76F};
  constexpr vec3 kHigh{0.05F, 0.14F, 0.46F};
  constexpr vec3 kSun{1.0F, 0.93F, 0.62F};
  const Backdrop& backdrop = *scene.backdrop;
  const auto x_m = static_cast<float>(point_m.x);
  const auto y_m = static_cast<float>(point_m.y);
  // Along the left wall, the back and the right wall, 0 in the middle of the back.
  const auto from_back_m = static_cast<float>(point_m.z - backdrop.back_z_m);
  const float u_m = x_m + std::copysign(from_back_m, x_m);
  const vec3 air = glm::mix(glm::mix(kLow, kMiddle, glm::smoothstep(-0.35F, 0.35F, y_m)), kHigh,
                            glm::smoothstep(0.05F, 1.35F, y_m));
  const float from_sun_m = glm::length(vec2(u_m + 0.26F, y_m - 0.27F));
  const float glow = std::exp(-from_sun_m * from_sun_m / 0.09F);
  const float disc = 1.0F - glm::smoothstep(0.085F, 0.092F, from_sun_m);
  const vec3 cloud = glm::mix(vec3(0.98F, 0.86F, 0.74F), vec3(0.92F, 0.92F, 0.95F),
                              glm::smoothstep(0.0F, 1.0F, y_m));
  const vec3 sky = glm::mix(air + 0.35F * glow * kSun, kSun, disc);
  const float clear = glm::smoothstep(0.08F, 0.30F, from_sun_m);  // no cloud before the sun
  return glm::mix(sky, cloud, clear * cloudShare(u_m, y_m, static_cast<float>(scene.phase_rad)));
}

vec3 pavedGroundTexture(vec2 xz, float edge_m) {
  constexpr float kTile_m = 0.16F;
  constexpr vec3 kLight{0.72F, 0.62F, 0.46F};
  constexpr vec3 kDark{0.40F, 0.22F, 0.16F};
  const float grain = 0.06F * std::sin(21.0F * xz.x + 13.0F * xz.y);
  return glm::mix(kDark, kLight, checker(xz / kTile_m, edge_m / kTile_m)) * (1.0F + grain);
}

vec3 boardTexture(vec2 uv_m, vec2 half_size_m, float edge_m) {
  constexpr float kCell_m = 0.0092F;
  constexpr float kLineHalfHeight_m = 0.030F;
  constexpr float kLinesFrom_m = 0.285F;
  constexpr float kTrim_m = 0.010F;
  if (half_size_m.y - uv_m.y < kTrim_m) return kInk;
  const float grain = 1.0F + 0.12F * std::sin(130.0F * uv_m.y + 2.0F * std::sin(5.0F * uv_m.x));
  const vec2 middle_m{uv_m.x, uv_m.y - 0.012F};
  const vec2 in_name{middle_m.x / kCell_m + 0.5F * kNameColumns,
                     0.5F * kLetterRows - middle_m.y / kCell_m};
  float ink = inkShare(in_name, edge_m / kCell_m);
  if (std::abs(middle_m.y) < kLineHalfHeight_m) {
    // To both sides of the name, the finest lines outside.
    ink = std::max(ink, lineShare(std::abs(middle_m.x) - kLinesFrom_m, edge_m));
  }
  return glm::mix(kWood * grain, kInk, ink);
}

}  // namespace viewloom::synthetic
